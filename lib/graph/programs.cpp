// SPDX-License-Identifier: Apache-2.0
#include <graph/programs.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <utility>

#include <graph/process.h>
#include <hc/base/suggestion.h>
#include <hc/os/procfs.h>
#include <hc/os/wait_readable.h>

namespace hc {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using MonotonicClock = std::chrono::steady_clock;

namespace {

// For a program that does not compute, and for one that does, as on a busy machine.
constexpr std::chrono::seconds kDescribeTime{10}, kMostDescribeTime{60};
constexpr std::size_t kMaxDescription = std::size_t{1} << 20;
constexpr std::size_t kMaxLine = 300;

bool is_program(const fs::path& path) {
  std::error_code missing;
  return fs::is_regular_file(path, missing) && ::access(path.c_str(), X_OK) == 0;
}

struct Described {
  int status = 0;
  std::string text;
};

/// Of a process and its descendants.
std::chrono::nanoseconds processor_time(pid_t process) {
  auto all = descendants(process);
  all.push_back(process);
  return usage_of(all, false).processor;
}

/// Runs `program --describe` to its end.
Result<Described> run_describe(const std::string& program, Process::Capture capture, int stop) {
  auto process = HC_TRY(Process::start({program, "--describe"}, capture));
  Described described;
  const auto begin = MonotonicClock::now();
  auto patience = kDescribeTime;
  std::chrono::nanoseconds computed{0};
  auto wait = [&](int descriptor) -> Status {
    std::array<int, 1> descriptors = {descriptor};
    while (true) {
      auto left = std::chrono::ceil<milliseconds>(begin + patience - MonotonicClock::now());
      auto ready = HC_TRY(wait_readable(descriptors, stop, std::max(left, milliseconds(0))));
      if (ready != 1) return {};
      const auto before = std::exchange(computed, processor_time(process.number()));
      if (computed == before || patience == kMostDescribeTime)
        return Error{Code::System, program + " --describe has not ended after " +
                                       std::to_string(patience.count()) + " s"};
      patience += kDescribeTime;
    }
  };
  while (described.text.size() <= kMaxDescription) {
    HC_TRY(wait(process.output()));
    char piece[4096];
    ssize_t size = ::read(process.output(), piece, sizeof piece);
    if (size > 0) described.text.append(piece, static_cast<std::size_t>(size));
    if (size != 0) continue;
    HC_TRY(wait(process.ended()));
    described.status = process.poll_status().value_or(0);
    return described;
  }
  return Error{Code::System, program + " --describe prints more than 1 MiB"};
}

std::string last_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  return text.substr(text.rfind('\n') + 1, kMaxLine);
}

}  // namespace

fs::path module_folder() {
  std::error_code unknown;
  fs::path self = fs::read_symlink("/proc/self/exe", unknown);
  return self.parent_path().parent_path() / "libexec" / "hypercolumn";
}

fs::path graph_folder() {
  return module_folder().parent_path().parent_path() / "share" / "hypercolumn" / "graphs";
}

std::vector<std::string> module_names() {
  std::vector<std::string> names;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(module_folder(), missing))
    if (entry.is_regular_file()) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
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

std::string no_program(const std::string& name, const std::string& path) {
  const std::string text = "no program \"" + name + "\"";
  std::error_code missing;
  if (path.find('/') != std::string::npos) {
    if (fs::is_directory(path, missing)) return path + " is a folder, not a program";
    if (fs::exists(path, missing)) return path + " is not executable";
    return text;
  }
  // In a build tree, some modules may not be built yet.
  const auto build = module_folder().parent_path().parent_path();
  if (fs::exists(build / "CMakeCache.txt", missing) &&
      fs::is_directory(build.parent_path() / "modules" / name, missing))
    return text + ": it is not built; ./dev build builds all modules";
  return text + suggestion(name, module_names());
}

Result<std::string> describe_program(const std::string& program, int stop) {
  auto described = HC_TRY(run_describe(program, Process::Capture::Output, stop));
  if (described.status == 0) return std::move(described.text);
  // Run it again for its error message: only one stream of a process is captured.
  const auto failed = run_describe(program, Process::Capture::Errors, stop);
  const auto line = failed ? last_line(failed->text) : "";
  return Error{Code::System, program + " --describe failed with status " +
                                 std::to_string(described.status) +
                                 (line.empty() ? "" : ": " + line) +
                                 "; see spec/module.md for the description of a program"};
}

}  // namespace hc
