// SPDX-License-Identifier: Apache-2.0
#include "common.h"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <set>

#include <hc/base/format.h>
#include <hc/base/visible.h>
#include <hc/os/program.h>
#include <record/writer.h>

namespace tool {
namespace {

namespace fs = std::filesystem;

void check_word(const std::string& word) {
  if (word.empty()) throw Failure(hc::Code::Invalid, "a link or file cannot be \"\"");
  if (value_or_fail(hc::record::place_of(word)).uri.scheme == "inproc")
    throw Failure(word, hc::Error{hc::Code::Invalid, "inproc links threads of one program"});
}

/// Writes to standard error, ignoring errors.
void write_error(const std::string& text) {
  static_cast<void>(hc::write_all(STDERR_FILENO, text));
}

}  // namespace

hc::LinkOptions link_options(std::uint64_t limit) {
  hc::LinkOptions options;
  options.limits.element_bytes = limit;
  options.stop = hc::stop_descriptor();
  options.log = [](hc::Level, std::string_view line) { say(line); };
  return options;
}

std::unique_ptr<hc::Source> open_source(const std::string& uri, std::uint64_t limit) {
  check_word(uri);
  return value_or_fail(hc::record::open_source(uri, link_options(limit)), uri);
}

std::unique_ptr<hc::Sink> open_sink(const std::string& uri) {
  check_word(uri);
  const auto place = value_or_fail(hc::record::place_of(uri));
  return value_or_fail(hc::record::open_sink(place, link_options()), uri);
}

std::unique_ptr<hc::record::Reader> open_recording(const std::vector<hc::record::Place>& places,
                                                   std::uint64_t limit, hc::record::Topics topics) {
  return value_or_fail(hc::record::Reader::open(places, link_options(limit), topics),
                       places.front().text());
}

std::unique_ptr<hc::Source> open_file_source(const std::string& path, std::uint64_t limit) {
  return value_or_fail(hc::open_source({"file", path, {}}, link_options(limit)), path);
}

std::unique_ptr<hc::Sink> open_file_sink(const std::string& path) {
  return value_or_fail(hc::open_sink({"file", path, {}}, link_options()), path);
}

bool receive(hc::Source& source, hc::Message& message, const std::string& uri) {
  if (hc::stop_requested()) return false;
  auto got = hc::receive(source, message, hc::stop_descriptor());
  if (!got && got.error().code == hc::Code::Stopped) return false;
  return value_or_fail(std::move(got), uri);
}

bool receive(hc::Source& source, hc::Message& message, const std::string& uri,
             std::string_view verb, bool is_skipping) {
  using hc::Code;
  // Each attempt may read as much as a damaged header says, so their number is limited.
  constexpr int kMostInARow = 1000;
  for (int in_a_row = 1;; ++in_a_row) try {
      return receive(source, message, uri);
    } catch (const Failure& failure) {
      const bool is_damage = failure.code == Code::Malformed || failure.code == Code::TooLarge ||
                             failure.code == Code::Unsupported || failure.code == Code::Truncated;
      if (!is_skipping || !is_damage || in_a_row > kMostInARow) throw;
      say(hc::format("{}: {}", verb, failure.what()));
      if (auto resumed = source.resume(); !resumed) throw Failure(uri, resumed.error());
    }
}

bool send(hc::Sink& sink, const hc::Message& message, const std::string& uri) {
  auto sent = sink.send(message);
  if (sent) return true;
  if (sent.error().code != hc::Code::Closed) throw Failure(uri, sent.error());
  return false;
}

std::string losses_in_words(const hc::Traffic& traffic) {
  std::vector<std::string> reasons;
  for (auto [count, reason] : {std::pair(traffic.throttled, "throttled"),
                               {traffic.dropped_newer, "dropped (newer arrived)"},
                               {traffic.dropped_memory, "dropped (no memory left)"},
                               {traffic.dropped_disconnect, "lost without a reader"},
                               {traffic.dropped_timeout, "dropped (the reader hung)"}})
    if (count > 0) reasons.push_back(hc::format("{} {}", count, reason));
  return joined(reasons);
}

void say_losses(std::string_view verb, std::string_view uri, const hc::Traffic& traffic) {
  if (traffic.lost() == 0) return;
  say(hc::format("{}: {}: {}", verb, uri, losses_in_words(traffic)));
}

bool print(std::string_view text) {
  auto written = hc::write_all(STDOUT_FILENO, text);
  if (written) return true;
  if (written.error().code != hc::Code::Closed) throw Failure("standard output", written.error());
  return false;
}

void allow_descriptors() {
  constexpr rlim_t kWanted = rlim_t{64} << 10;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kWanted) return;
  limit.rlim_cur = std::min(kWanted, limit.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

TerminalSize terminal_size() {
  winsize size{};
  for (const int terminal : {STDOUT_FILENO, STDERR_FILENO})
    if (::ioctl(terminal, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
      return {size.ws_col, size.ws_row};
  return {};
}

void say(std::string_view lines) {
  std::string text;
  while (!lines.empty()) {
    const auto line = lines.substr(0, lines.find('\n'));
    text += hc::visible(line) + "\n";
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
  }
  write_error(text);
}

std::string find_graph(const std::string& name) {
  std::error_code missing;
  const auto type = fs::status(name, missing).type();
  const bool is_file = type != fs::file_type::not_found && type != fs::file_type::directory;
  if (name.find('/') != std::string::npos || is_file) return name;
  const fs::path folder = hc::graph_folder();
  for (const char* suffix : {"", ".toml"})
    if (fs::is_regular_file(folder / (name + suffix), missing)) return folder / (name + suffix);
  return name;
}

std::vector<std::string> shipped_graphs() {
  std::set<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(hc::graph_folder(), missing))
    if (entry.path().extension() == ".toml") names.insert(entry.path().stem().string());
  return {names.begin(), names.end()};
}

std::string meant_command(const std::string& word) {
  for (const auto& [name, hint] :
       {std::pair("stop", "to stop the robot: hc estop; to end the running graph: hc graph stop"),
        {"kill", "to end the running graph: hc graph stop"},
        {"start", "to run a graph: hc run"},
        {"list", "hc ps lists the running graphs, hc ports their ports, hc --help all commands"},
        {"ls", "hc ps lists the running graphs, hc ports their ports, hc --help all commands"},
        {"echo", "to print what a port sends: hc cat MODULE.PORT"},
        {"node", "hc ps lists the running graphs, hc graph get their modules' parameters"},
        {"topic", "hc ports lists the ports of a running graph, hc cat prints what one sends"},
        {"param", "hc graph get and hc graph set: parameters"},
        {"bag", "hc record, hc play and hc info: recordings"},
        {"launch", "to run a graph: hc run"},
        {"set", "to set a parameter: hc graph set MODULE.PARAMETER=VALUE"},
        {"get", "to print parameters: hc graph get"}})
    if (word == name) return std::string("; ") + hint;
  return "";
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const auto& word : words) text.append(text.empty() ? "" : between).append(word);
  return text;
}

std::string counted(std::uint64_t number, std::string_view what) {
  return hc::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

std::string seconds_in_words(double seconds) {
  constexpr std::int64_t kMinute = 60, kHour = 60 * kMinute, kDay = 24 * kHour;
  auto whole = static_cast<std::int64_t>(seconds);
  if (whole < kMinute) return hc::format("{} s", whole);
  if (whole < kHour) return hc::format("{}:{:02} min", whole / kMinute, whole % kMinute);
  if (whole < 2 * kDay) return hc::format("{}:{:02} h", whole / kHour, whole / kMinute % 60);
  return hc::format("{} d", whole / kDay);
}

std::string bytes_in_words(std::uint64_t bytes) {
  constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
  auto size = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; size >= 1000 && unit + 1 < std::size(kUnits); ++unit) size /= 1000;
  return unit == 0 ? hc::format("{} B", bytes) : hc::format("{:.3g} {}", size, kUnits[unit]);
}

Progress::Progress(std::string what)
    : what_(std::move(what)), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_ != 0) write_error("\r\033[K");
}

void Progress::show(double share, std::string_view words) {
  using namespace std::chrono;
  if (!on_terminal_) return;
  constexpr std::int64_t kPeriod = 100;
  auto now = duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
  if (now - shown_ < kPeriod) return;
  shown_ = now;
  constexpr int kCells = 30;
  std::string bar;
  if (share >= 0) {
    int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * kCells);
    bar = hc::format("[{}{}] {:3.0f} % ", std::string(static_cast<std::size_t>(full), '#'),
                     std::string(static_cast<std::size_t>(kCells - full), '.'), share * 100);
  }
  write_error(hc::format("\r\033[K{} {}{}", what_, bar, words));
}

}  // namespace tool
