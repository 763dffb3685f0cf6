// SPDX-License-Identifier: Apache-2.0
#include "screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common.h"

namespace tool {
namespace {

using nlohmann::json;

constexpr std::string_view kBold = "\x1b[1m", kRed = "\x1b[31m", kDim = "\x1b[2m",
                           kNormal = "\x1b[0m";

constexpr std::size_t kName = 18;     // of a module [character]
constexpr std::size_t kNumbers = 42;  // of a link: the width of all columns but the first

struct Line {
  std::string text;
  bool is_bold = false, is_red = false, is_dim = false;
};

/// Cuts text to so many characters, counting those of UTF-8, with a mark where some are left out.
std::string fitted(const std::string& text, std::size_t width) {
  auto is_begin = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  auto count = static_cast<std::size_t>(std::count_if(text.begin(), text.end(), is_begin));
  if (count <= width) return text + std::string(width - count, ' ');
  std::string cut;
  std::size_t taken = 0;
  for (char c : text) {
    if (is_begin(c) && ++taken >= width) break;
    cut += c;
  }
  return cut + "…";
}

/// A time in five characters.
std::string short_time(double seconds) {
  return seconds < 0 ? "-" : short_number(seconds) + "s";
}

std::string quantile(const json& times, std::size_t index) {
  return times.is_null() ? "-" : short_time(times.at(index).get<double>());
}

std::string short_count(std::uint64_t count) {
  return count == 0 ? "-" : short_number(static_cast<double>(count));
}

bool is_wrong(const std::string& status) {
  return status == "given up" || status == "stalled" || status == "waiting";
}

std::string heading(const json& state) {
  std::size_t up = 0;
  double rate = 0, load = 0;
  for (const auto& module : state.at("modules")) {
    up += module.at("status") == "running" ? 1 : 0;
    load += module.at("cpu").get<double>();
  }
  for (const auto& link : state.at("links")) rate += link.at("per_second").get<double>();
  const auto& focus = state.at("focus");
  return fmt::format("{}: {} {}, {}/{} modules up, {} messages/s, {:.0f} % CPU{}",
                     state.at("graph").get<std::string>(), state.at("status").get<std::string>(),
                     seconds_in_words(state.at("uptime").get<double>()), up,
                     state.at("modules").size(), short_number(rate), 100 * load,
                     focus.is_null() ? "" : ", focus " + focus.at("mode").get<std::string>());
}

Line module_line(const json& module, std::size_t width) {
  Line line;
  auto status = module.at("status").get<std::string>();
  auto detail = module.at("detail").get<std::string>();
  const bool is_running = status == "running";
  if (is_running && !module.at("in_focus").get<bool>()) status = "idle";
  if (!detail.empty()) status = is_running ? detail : status + ": " + detail;
  line.is_red = is_wrong(module.at("status"));
  line.is_bold = module.at("in_workspace").get<bool>();
  line.is_dim = !module.at("in_focus").get<bool>();
  auto fixed = fmt::format(
      " {:>6} {:>8} {:>3} {:<7} ", fmt::format("{:.1f}%", 100 * module.at("cpu").get<double>()),
      bytes_in_words(module.at("memory").get<double>()), module.at("restarts").get<int>(),
      fitted(module.at("mode").get<std::string>(), 7));
  const std::size_t name = kName;
  auto rest = width > name + fixed.size() ? width - name - fixed.size() : 1;
  line.text = fitted(module.at("name"), name) + fixed + fitted(status, rest);
  return line;
}

Line link_line(const json& link, std::size_t width) {
  Line line;
  std::uint64_t lost = 0;
  for (const auto& count : link.at("lost")) lost += count.get<std::uint64_t>();
  line.is_bold = link.at("in_workspace").get<bool>();
  auto fixed = fmt::format(
      " {:>5} {:>6} {:>6} {:>6} {:>5} {:>8}", short_number(link.at("per_second").get<double>()),
      short_number(link.at("bytes_per_second").get<double>()) + "B", quantile(link.at("age"), 0),
      quantile(link.at("age"), 1), short_count(lost),
      short_count(link.at("left_out").get<std::uint64_t>()));
  auto name = width > kNumbers + 10 ? width - kNumbers : 10;
  auto rate = link.at("rate").get<double>();  // that the link does not exceed
  auto limit = rate > 0 ? " ≤" + short_number(rate) + "/s" : "";
  line.text =
      fitted(link.at("from").get<std::string>() + " → " + link.at("to").get<std::string>() + limit,
             name) +
      fixed;
  return line;
}

/// As many of the lines as there is room for, those that are wrong before the others, and how many
/// are left out.
void add_some(std::vector<Line> lines, std::size_t room, std::vector<Line>& all) {
  if (lines.size() > room)
    std::stable_sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
      return std::pair(!a.is_red, !a.is_bold) < std::pair(!b.is_red, !b.is_bold);
    });
  const bool some = lines.size() > room;
  const std::size_t count = some ? (room > 0 ? room - 1 : 0) : lines.size();
  for (std::size_t i = 0; i < count; ++i) all.push_back(lines[i]);
  if (some && room > 0)
    all.push_back({fmt::format("… and {} more", lines.size() - count), false, false, true});
}

}  // namespace

std::string short_number(double number) {
  constexpr std::array<const char*, 9> kPrefixes = {"n", "µ", "m", "", "k", "M", "G", "T", "P"};
  if (number == 0 || !std::isfinite(number)) return "0";
  std::size_t prefix = 3;
  double size = std::abs(number);
  while (size >= 999.5 && prefix + 1 < kPrefixes.size()) size /= 1000, ++prefix;
  while (size < 0.9995 && prefix > 0) size *= 1000, --prefix;
  int digits = size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  if (prefix == 3 && size == std::floor(size)) digits = 0;
  return fmt::format("{}{:.{}f}{}", number < 0 ? "-" : "", size, digits, kPrefixes.at(prefix));
}

std::string draw(const json& state, const Screen& screen) {
  std::vector<Line> lines, modules, links;
  for (const auto& module : state.at("modules"))
    modules.push_back(module_line(module, screen.width));
  for (const auto& link : state.at("links")) links.push_back(link_line(link, screen.width));
  lines.push_back({heading(state), true});
  const std::size_t headings = links.empty() ? 3 : 5;
  std::size_t room = screen.height == 0         ? modules.size() + links.size()
                     : screen.height > headings ? screen.height - headings
                                                : 0;
  // Modules and links share the room; who needs less than half leaves the rest to the other.
  std::size_t for_modules =
      std::min(modules.size(), std::max(room - std::min(room, links.size()), room / 2));
  lines.push_back({});
  lines.push_back(
      {fitted("MODULE", kName) + "    CPU   MEMORY NEW MODE    STATUS", false, false, true});
  add_some(std::move(modules), for_modules, lines);
  if (!links.empty()) {
    lines.push_back({});
    auto column = screen.width > kNumbers + 10 ? screen.width - kNumbers : 10;
    lines.push_back({fitted("LINK", column) + "   1/s    B/s    AGE    p99  LOST LEFT OUT", false,
                     false, true});
    add_some(std::move(links), room - for_modules, lines);
  }
  std::string text;
  for (const auto& line : lines) {
    auto fit = fitted(line.text, screen.width);
    fit.erase(fit.find_last_not_of(' ') + 1);
    if (!screen.is_plain) {
      if (line.is_bold) text += kBold;
      if (line.is_red) text += kRed;
      if (line.is_dim && !line.is_bold) text += kDim;
    }
    text += fit;
    if (!screen.is_plain && (line.is_bold || line.is_red || line.is_dim)) text += kNormal;
    text += '\n';
  }
  return text;
}

}  // namespace tool
