// SPDX-License-Identifier: Apache-2.0
#include "screen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <hc/base/format.h>
#include <hc/base/visible.h>

#include "common.h"

namespace tool {
namespace {

constexpr std::string_view kRed = "\x1b[31m", kDim = "\x1b[2m";

struct Line {
  std::string text;
  bool is_bold = false, is_red = false, is_dim = false;
};

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // UTF-8
}

std::size_t length(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), begins_character));
}

/// Text padded or cut (with "…") to a width, with control characters escaped.
std::string fitted(const std::string& given, std::size_t width) {
  const auto text = hc::visible(given);
  const auto count = length(text);
  std::string cut;
  std::size_t taken = 0;
  for (char c : text) {
    if (count > width && begins_character(c) && ++taken >= width) break;
    cut += c == '\t' ? ' ' : c;
  }
  return count > width ? cut + "…" : cut + std::string(width - count, ' ');
}

std::string in_front(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, length(text)), ' ') + text;
}

std::string short_count(std::uint64_t count) {
  return count == 0 ? "-" : short_number(static_cast<double>(count));
}

double messages_per_second(const hc::GraphState& state) {
  double rate = 0;
  for (const auto& link : state.links) rate += link.per_second;
  return rate;
}

std::string heading(const hc::GraphState& state) {
  double load = 0;
  std::size_t up = 0;
  for (const auto& module : state.modules) {
    up += module.status == hc::ModuleStatus::Running ? 1 : 0;
    load += module.processor;
  }
  const auto focus = state.focus_in_words(), stopped = state.stopped_in_words();
  return hc::format("{}: {} {}, {}/{} modules up, {} messages/s, {:.0f} % CPU{}", state.name,
                    state.is_stopping ? "stopping" : "running", seconds_in_words(state.uptime), up,
                    state.modules.size(), short_number(messages_per_second(state)), 100 * load,
                    focus.empty() ? "" : ", focus " + focus) +
         (stopped.empty() ? "" : ", " + stopped);
}

std::string bids_line(const std::vector<Bid>& bids) {
  std::string text;
  for (const auto& bid : bids)
    text += hc::format("{}{}{} {:.2f}{}{}", text.empty() ? "bids: " : ", ",
                       bid.workspace.empty() ? "" : bid.workspace + ": ", bid.mode, bid.salience,
                       bid.is_person ? " (person)" : "", bid.in_focus ? " *" : "");
  return text;
}

/// A column: heading, width, and the text of a cell.
template <typename Row>
struct Column {
  std::string name;
  std::size_t width;
  std::string (*cell)(const Row& row);
};

/// The cells of a row, or with null the headings.
template <typename Row>
std::string cells(const std::vector<Column<Row>>& columns, const Row* row = nullptr) {
  std::string text;
  for (const auto& [name, width, cell] : columns)
    text += in_front(row != nullptr ? cell(*row) : name, width);
  return text;
}

/// The mode of each module that works for a task in focus: tasks of that mode, and modules without
/// a mode whose messages lead to them.
std::map<std::string, std::string> contributors(const hc::GraphState& state) {
  std::map<std::string, const hc::ModuleState*> modules;
  std::map<std::string, std::string> found;
  for (const auto& module : state.modules) {
    modules[module.name] = &module;
    if (!module.mode.empty() && module.mode == state.focus_of(module))
      found.emplace(module.name, module.mode);
  }
  for (bool is_more = true; is_more;) {
    is_more = false;
    for (const auto& link : state.links) {
      const auto from = modules.find(link.from.substr(0, link.from.find('.')));
      if (from == modules.end() || !from->second->mode.empty() || state.focus.contains(from->first))
        continue;
      if (const auto to = found.find(link.to.substr(0, link.to.find('.'))); to != found.end())
        is_more = found.emplace(from->first, to->second).second || is_more;
    }
  }
  return found;
}

/// MODULE or MODULE@HOST, as for `hc graph add`.
std::string full_name(const hc::ModuleState& module) {
  return module.host.empty() ? module.name : module.name + "@" + module.host;
}

/// Such as "host robot: clock +3600.000 s ± 120µs, 250µs there and back".
Line host_line(const hc::HostState& host) {
  if (!host.is_connected || !host.offset || !host.error || !host.latency)
    return {"host " + host.name + ": not connected: " + host.detail, false, true};
  return {hc::format("host {}: clock {}{} ± {}, {} there and back", host.name,
                     *host.offset < 0 ? "-" : "+", short_time(std::abs(*host.offset)),
                     short_time(*host.error), short_time(*host.latency))};
}

void add_modules(const hc::GraphState& state, std::vector<Line>& lines) {
  const std::vector<Column<hc::ModuleState>> columns = {
      {"CPU", 7, [](const auto& m) { return hc::format("{:.1f}%", 100 * m.processor); }},
      {"MEMORY", 9, [](const auto& m) { return bytes_in_words(m.memory); }},
      {"RESTARTS", 9, [](const auto& m) { return std::to_string(m.restarts); }},
  };
  constexpr std::size_t kMaxName = 24, kMaxMode = 12;
  std::size_t name = 6, mode = 4;
  const auto contributing = contributors(state);
  auto mode_of = [&](const hc::ModuleState& module) {
    const auto borrowed = contributing.find(module.name);
    return module.mode.empty() && borrowed != contributing.end() ? "(" + borrowed->second + ")"
                                                                 : module.mode;
  };
  for (const auto& module : state.modules) {
    name = std::max(name, std::min(kMaxName, length(full_name(module))));
    mode = std::max(mode, std::min(kMaxMode, length(mode_of(module))));
  }
  lines.push_back(
      {fitted("MODULE", name) + cells(columns) + "  " + fitted("MODE", mode) + " STATUS", false,
       false, true});
  for (const auto& module : state.modules) {
    auto status = status_text(module);
    if (!module.last_line.empty())
      status += hc::format(" | {} ({} ago)", module.last_line,
                           seconds_in_words(std::max(0.0, module.last_line_age)));
    const auto text = fitted(full_name(module), name) + cells(columns, &module) + "  " +
                      fitted(mode_of(module), mode) + " " + status;
    lines.push_back({text, module.in_workspace, is_in_trouble(module),
                     !module.in_focus && !is_in_trouble(module)});
  }
}

/// Such as "at most 500kB/s: quality 62, scale 0.75".
std::string bandwidth_in_words(const hc::LinkState& link) {
  const auto limit = "at most " + short_number(link.bandwidth) + "B/s";
  if (!link.images) return limit;
  const auto [quality, scale] = *link.images;
  return hc::format("{}: quality {:.0f}, scale {:.3g}", limit, quality, scale);
}

void add_links(const hc::GraphState& state, std::size_t width, std::vector<Line>& lines) {
  std::vector<Column<hc::LinkState>> columns = {
      {"1/s", 6, [](const auto& l) { return short_number(l.per_second); }},
      {"B/s", 7, [](const auto& l) { return short_number(l.bytes_per_second) + "B"; }},
      {"AGE", 7, [](const auto& l) { return l.age ? short_time(l.age->at(0)) : "-"; }},
      {"p99", 7, [](const auto& l) { return l.age ? short_time(l.age->at(1)) : "-"; }},
      {"THROTTLED", 10, [](const auto& l) { return short_count(l.traffic.throttled); }},
      {"DROPPED", 8,
       [](const auto& l) { return short_count(l.traffic.lost() - l.traffic.throttled); }},
      {"IGNORED", 8, [](const auto& l) { return short_count(l.ignored); }},
  };
  constexpr std::size_t kWide = 100;
  if (width < kWide) columns.erase(columns.begin() + 3);
  std::size_t numbers = 0, name = 4;
  for (const auto& column : columns) numbers += column.width;
  for (const auto& link : state.links) name = std::max(name, length(link.from + " → " + link.to));
  name = std::max<std::size_t>(10, std::min(name, width - std::min(width, numbers)));
  std::set<std::string> down;
  for (const auto& module : state.modules)
    if (module.status != hc::ModuleStatus::Running) down.insert(module.name);
  lines.push_back({fitted("LINK", name) + cells(columns), false, false, true});
  for (const auto& link : state.links) {
    std::string notes;
    auto note = [&](const std::string& text) {
      if (!text.empty()) notes += (notes.empty() ? "  " : ", ") + text;
    };
    note(link.status);
    if (link.rate > 0) note("at most " + short_number(link.rate) + "/s");
    if (link.bandwidth > 0) note(bandwidth_in_words(link));
    note(losses_in_words(link.traffic));
    if (link.ignored > 0) note("ignored: not in focus");
    if (link.traffic.bad > 0) note(std::to_string(link.traffic.bad) + " bad");
    const auto text = fitted(link.from + " → " + link.to, name) + cells(columns, &link) + notes;
    lines.push_back({text, link.in_workspace, !link.status.empty()});
  }
}

/// Moves lines in trouble to the front.
void sort(std::vector<Line>::iterator begin, std::vector<Line>::iterator end) {
  std::stable_sort(begin, end, [](const Line& a, const Line& b) { return a.is_red && !b.is_red; });
}

std::string painted(Line line, const Screen& screen) {
  line.text = fitted(line.text, std::min(screen.width, length(line.text)));
  line.text.erase(line.text.find_last_not_of(' ') + 1);
  std::string begin;
  if (line.is_bold) begin += kBold;
  if (line.is_red) begin += kRed;
  if (line.is_dim && !line.is_bold) begin += kDim;
  if (screen.is_plain || begin.empty()) return line.text + "\n";
  return begin + line.text + std::string(kNormal) + "\n";
}

}  // namespace

std::string status_line(const hc::GraphState& state) {
  using enum hc::ModuleStatus;
  std::vector<std::string> modules;
  for (const auto status : {Running, Starting, Stalled, Waiting, Stopping, Ended, GivenUp})
    if (const auto count = std::ranges::count(state.modules, status, &hc::ModuleState::status);
        count > 0)
      modules.push_back(hc::format("{} {}", count, hc::name(status)));
  const auto focus = state.focus_in_words(), stopped = state.stopped_in_words();
  return hc::format("{} | {:.0f} messages/s{}{}", joined(modules), messages_per_second(state),
                    focus.empty() ? "" : " | focus: " + focus,
                    stopped.empty() ? "" : " | " + stopped);
}

bool is_in_trouble(const hc::ModuleState& module) {
  using enum hc::ModuleStatus;
  if (module.status == GivenUp || module.status == Stalled || module.status == Waiting) return true;
  if (module.status == Running && (module.waits || !module.detail.empty())) return true;
  if (module.status == Ended) return false;
  return module.last_level == hc::Level::Warning || module.last_level == hc::Level::Error;
}

std::string status_text(const hc::ModuleState& module) {
  std::string status{name(module.status)};
  const bool is_running = module.status == hc::ModuleStatus::Running;
  if (is_running && !module.in_focus) status = "idle (not in focus)";
  if (is_running && module.waits && !module.waits_for.empty())
    return hc::format("has waited {} for {}", seconds_in_words(*module.waits), module.waits_for);
  if (module.detail.empty()) return status;
  return is_running ? module.detail : status + ": " + module.detail;
}

std::string short_number(double number) {
  constexpr std::array<const char*, 6> kPrefixes = {"", "k", "M", "G", "T", "P"};
  if (number == 0 || !std::isfinite(number)) return "0";
  std::size_t prefix = 0;
  double size = std::abs(number);
  while (size >= 999.5 && prefix + 1 < kPrefixes.size()) size /= 1000, ++prefix;
  int digits = size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  if (prefix == 0 && size == std::floor(size)) digits = 0;
  return hc::format("{}{:.{}f}{}", number < 0 ? "-" : "", size, digits, kPrefixes.at(prefix));
}

std::string short_time(double seconds) {
  if (seconds < 0) return "-";
  for (auto [unit, name] : {std::pair(1.0, "s"), {1e-3, "ms"}, {1e-6, "µs"}})
    if (seconds >= 0.9995 * unit) return short_number(seconds / unit) + name;
  return short_number(seconds * 1e9) + "ns";
}

std::string draw(const hc::GraphState& state, const std::vector<Bid>& bids, const Screen& screen) {
  std::vector<Line> fixed = {{heading(state), true}}, lines;
  if (!bids.empty()) fixed.push_back({bids_line(bids)});
  for (const auto& host : state.hosts) fixed.push_back(host_line(host));
  fixed.push_back({});
  add_modules(state, lines);
  sort(lines.begin() + 1, lines.end());
  if (!state.links.empty()) {
    lines.push_back({});
    const auto begin = static_cast<std::ptrdiff_t>(lines.size()) + 1;
    add_links(state, screen.width, lines);
    sort(lines.begin() + begin, lines.end());
  }
  if (screen.height > 0) {
    fixed.resize(std::min(fixed.size(), screen.height));
    const std::size_t room = screen.height - fixed.size();
    if (lines.size() > room && room > 1) {
      const std::size_t shown = room - 1, first = std::min(screen.first, lines.size() - shown);
      const auto more = hc::format("lines {} to {} of {}; arrow keys scroll, q quits", first + 1,
                                   first + shown, lines.size());
      lines = {lines.begin() + static_cast<std::ptrdiff_t>(first),
               lines.begin() + static_cast<std::ptrdiff_t>(first + shown)};
      lines.push_back({more, false, false, true});
    }
    lines.resize(std::min(lines.size(), room));
  }
  std::string text;
  for (const auto* some : {&fixed, &lines})
    for (const auto& line : *some) text += painted(line, screen);
  return text;
}

}  // namespace tool
