// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lines for a log that come from any thread, and are logged on the one that the log belongs to.
// Internal.

#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/log.h>

namespace hc::internal {

/// Keeps what is to be logged, kMost lines at most, as others may have us say much.
class Remarks {
 public:
  static constexpr std::size_t kMost = 64;

  void add(std::string line, Level level = Level::Warning) {
    std::lock_guard lock(mutex_);
    if (lines_.size() < kMost)
      lines_.emplace_back(level, std::move(line));
    else
      ++more_;
    any_.store(true, std::memory_order_relaxed);
  }

  /// Logs what there is. Cost: next to nothing when there is nothing.
  void flush(const LogSink& log) {
    if (!any_.load(std::memory_order_relaxed)) return;
    std::unique_lock lock(mutex_);
    any_.store(false, std::memory_order_relaxed);
    auto lines = std::exchange(lines_, {});
    if (auto more = std::exchange(more_, 0); more > 0)
      lines.emplace_back(Level::Warning, "and " + std::to_string(more) + " lines more");
    lock.unlock();
    if (!log) return;
    for (const auto& [level, line] : lines) log(level, line);
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<Level, std::string>> lines_;
  std::size_t more_ = 0;
  std::atomic<bool> any_{false};
};

}  // namespace hc::internal
