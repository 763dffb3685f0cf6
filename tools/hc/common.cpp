// SPDX-License-Identifier: Apache-2.0
#include "common.h"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>

namespace tool {
namespace {

namespace fs = std::filesystem;

int stop_event = -1;

extern "C" void ask_to_stop(int) {
  std::uint64_t one = 1;
  [[maybe_unused]] auto written = ::write(stop_event, &one, sizeof one);
}

hc::LinkOptions link_options() {
  hc::LinkOptions options;
  options.stop = stop_descriptor();
  options.log = [](hc::Severity, std::string_view line) { say(line); };
  return options;
}

bool is_program(const fs::path& path) {
  std::error_code missing;
  return fs::is_regular_file(path, missing) && ::access(path.c_str(), X_OK) == 0;
}

hc::Uri parse(const std::string& uri) {
  return value_or_fail(hc::parse_uri(uri), uri);
}

}  // namespace

int stop_descriptor() {
  if (stop_event >= 0) return stop_event;
  stop_event = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return stop_event;
}

std::unique_ptr<hc::Source> open_source(const std::string& uri, std::uint64_t limit) {
  auto options = link_options();
  options.limits.element_bytes = limit;
  return value_or_fail(hc::open_source(parse(uri), options), uri);
}

std::unique_ptr<hc::Sink> open_sink(const std::string& uri) {
  return value_or_fail(hc::open_sink(parse(uri), link_options()), uri);
}

bool receive(hc::Source& source, hc::Message& message, const std::string& uri) {
  auto got = hc::receive(source, message, stop_event);
  if (!got && got.error().code == hc::Code::Stopped) return false;
  return value_or_fail(std::move(got), uri);
}

bool send(hc::Sink& sink, const hc::Message& message) {
  auto sent = sink.send(message);
  if (sent) return true;
  if (sent.error().code != hc::Code::Closed) throw Failure(sent.error());
  return false;
}

bool print(std::string_view text) {
  while (!text.empty()) {
    ssize_t size = ::write(STDOUT_FILENO, text.data(), text.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(size));
  }
  return true;
}

void say(std::string_view line) {
  fmt::print(stderr, "{}\n", line);
}

fs::path module_folder() {
  std::error_code unknown;
  fs::path self = fs::read_symlink("/proc/self/exe", unknown);
  return self.parent_path().parent_path() / "libexec" / "hypercolumn";
}

std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) return is_program(name) ? name : "";
  fs::path own = module_folder() / name;
  if (is_program(own)) return own.string();
  const char* variable = std::getenv("PATH");
  std::string_view path = variable == nullptr ? "" : variable;
  while (!path.empty()) {
    auto colon = std::min(path.find(':'), path.size());
    fs::path candidate = fs::path(path.substr(0, colon)) / name;
    if (is_program(candidate)) return candidate.string();
    path.remove_prefix(std::min(colon + 1, path.size()));
  }
  return "";
}

std::vector<std::string> module_names() {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(module_folder(), missing))
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string bytes_in_words(double bytes) {
  constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1000 && unit + 1 < std::size(kUnits)) {
    bytes /= 1000;
    ++unit;
  }
  return unit == 0 ? fmt::format("{} B", bytes) : fmt::format("{:.3g} {}", bytes, kUnits[unit]);
}

Progress::Progress(std::string what)
    : what_(std::move(what)), on_terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (shown_ != 0) fmt::print(stderr, "\r\033[K");
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
    bar = fmt::format("[{}{}] {:3.0f} % ", std::string(static_cast<std::size_t>(full), '#'),
                      std::string(static_cast<std::size_t>(kCells - full), '.'), share * 100);
  }
  fmt::print(stderr, "\r\033[K{} {}{}", what_, bar, words);
}

}  // namespace tool
