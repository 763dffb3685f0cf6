// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a server's thread and others speak to one another.

#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include <hc/os/event.h>

namespace hc::web {

/// Has a function called on the server's thread, soon. From any thread.
using Post = std::function<void(std::function<void()>)>;

/// What other threads hand to one that waits for its descriptor.
class Inbox {
 public:
  /// From any thread.
  void put(std::function<void()> call) {
    const std::lock_guard lock(mutex_);
    calls_.push_back(std::move(call));
    event_.raise();
  }
  /// Calls all that was put.
  void work_off() {
    event_.clear();
    std::unique_lock lock(mutex_);
    auto calls = std::exchange(calls_, {});
    lock.unlock();
    for (auto& call : calls) call();
  }
  [[nodiscard]] int descriptor() const { return event_.descriptor(); }

 private:
  internal::Event event_ = internal::Event::must_make();
  std::mutex mutex_;
  std::vector<std::function<void()>> calls_;
};

}  // namespace hc::web
