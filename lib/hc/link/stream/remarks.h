// SPDX-License-Identifier: Apache-2.0
#pragma once
// Log lines from any thread, to be logged by the thread that owns the log. Internal.

#include <atomic>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/log.h>

namespace hc::internal {

/// Keeps at most kMost lines, so that peers cannot fill the memory.
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

  /// Logs the lines and removes them. Cost: one load if there are none.
  void flush(const LogSink& log) {
    if (!any_.load(std::memory_order_relaxed)) return;
    std::unique_lock lock(mutex_);
    any_.store(false, std::memory_order_relaxed);
    auto lines = std::exchange(lines_, {});
    if (auto more = std::exchange(more_, 0); more > 0)
      lines.emplace_back(Level::Warning, "and " + std::to_string(more) + " more lines");
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
