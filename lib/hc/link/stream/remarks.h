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

  void add(std::string line) {
    std::lock_guard lock(mutex_);
    if (lines_.size() < kMost)
      lines_.push_back(std::move(line));
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
      lines.push_back("and " + std::to_string(more) + " lines more");
    lock.unlock();
    if (!log) return;
    for (const auto& line : lines) log(Severity::Warning, line);
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
  std::size_t more_ = 0;
  std::atomic<bool> any_{false};
};

}  // namespace hc::internal
