// SPDX-License-Identifier: Apache-2.0
#include <hc/os/procfs.h>

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <string>
#include <string_view>

#include <hc/os/descriptor.h>

namespace hc {
namespace {

std::string text_of(const std::string& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  std::string text;
  char piece[4096];
  for (ssize_t size = 0; file && (size = ::read(file.get(), piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(size));
  return text;
}

/// The integers at the start of a text, separated by spaces.
std::vector<std::int64_t> numbers_in(std::string_view text) {
  std::vector<std::int64_t> numbers;
  while (!text.empty()) {
    std::int64_t number = 0;
    auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (status != std::errc()) break;
    numbers.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  }
  return numbers;
}

/// The children of one thread, eldest first.
std::vector<std::int64_t> children_of(pid_t process, const std::string& thread) {
  return numbers_in(text_of("/proc/" + std::to_string(process) + "/task/" + thread + "/children"));
}

std::vector<std::string> threads_of(pid_t process) {
  std::vector<std::string> threads;
  std::unique_ptr<DIR, int (*)(DIR*)> folder(
      ::opendir(("/proc/" + std::to_string(process) + "/task").c_str()), ::closedir);
  if (folder == nullptr) return threads;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): a stream of one thread
  while (const dirent* entry = ::readdir(folder.get()))
    if (entry->d_name[0] != '.') threads.emplace_back(entry->d_name);
  return threads;
}

/// The proportional set size, from "Pss: 1234 kB" [byte].
std::uint64_t memory_of(pid_t process) {
  constexpr std::string_view kKey = "\nPss:";
  auto text = text_of("/proc/" + std::to_string(process) + "/smaps_rollup");
  auto place = text.find(kKey);
  if (place == std::string::npos) return 0;
  std::string_view rest = std::string_view(text).substr(place + kKey.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  auto numbers = numbers_in(rest);
  return numbers.empty() ? 0 : static_cast<std::uint64_t>(numbers[0]) << 10;
}

}  // namespace

std::vector<pid_t> descendants(pid_t process) {
  std::vector<pid_t> all;
  auto add = [&](pid_t parent) {
    for (const auto& thread : threads_of(parent))
      for (auto child : children_of(parent, thread)) all.push_back(static_cast<pid_t>(child));
  };
  add(process);
  for (std::size_t known = 0; known < all.size();) add(all[known++]);
  return all;
}

Usage usage_of(const std::vector<pid_t>& processes, bool with_memory) {
  // Source: man 5 proc, /proc/pid/stat. Parsed from the end of the name, which may contain any
  // character: the state is field 0, and the times (14 to 17) are 10 to 13 of the numbers after it.
  constexpr std::size_t kFirstTime = 10, kTimes = 4;
  const auto tick = std::chrono::nanoseconds(std::nano::den / ::sysconf(_SC_CLK_TCK));
  Usage usage;
  for (auto process : processes) {
    auto text = text_of("/proc/" + std::to_string(process) + "/stat");
    auto name_end = text.rfind(") ");
    if (name_end == std::string::npos || name_end + 4 > text.size()) continue;
    const char state = text[name_end + 2];
    usage.is_stopped = usage.is_stopped || state == 'T' || state == 't';
    usage.is_traced = usage.is_traced || state == 't';
    auto numbers = numbers_in(std::string_view(text).substr(name_end + 4));
    for (std::size_t i = kFirstTime; i < kFirstTime + kTimes && i < numbers.size(); ++i)
      usage.processor += numbers[i] * tick;
    if (with_memory) usage.memory += memory_of(process);
    // Source: Documentation/scheduler/sched-stats.rst: the times on a processor, and waiting for
    // one.
    if (process != processes.front()) continue;
    const auto times = numbers_in(text_of("/proc/" + std::to_string(process) + "/schedstat"));
    if (times.size() > 1) usage.waited = std::chrono::nanoseconds(times[1]);
  }
  return usage;
}

}  // namespace hc
