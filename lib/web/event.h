// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a server's thread and others speak to one another.

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include <hc/base/check.h>

namespace hc::web {

/// Has a function called on the server's thread, soon. From any thread.
using Post = std::function<void(std::function<void()>)>;

/// A descriptor that is readable from set() to clear(). From any thread.
class Event {
 public:
  Event() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    HC_CHECK(descriptor_ >= 0, "eventfd");
  }
  ~Event() { ::close(descriptor_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  void set() {
    const std::uint64_t one = 1;
    [[maybe_unused]] const auto written = ::write(descriptor_, &one, sizeof one);
  }
  void clear() {
    std::uint64_t count = 0;
    [[maybe_unused]] const auto got = ::read(descriptor_, &count, sizeof count);
  }

 private:
  int descriptor_;
};

/// What other threads hand to one that waits for its descriptor.
class Inbox {
 public:
  /// From any thread.
  void put(std::function<void()> call) {
    const std::lock_guard lock(mutex_);
    calls_.push_back(std::move(call));
    event_.set();
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
  Event event_;
  std::mutex mutex_;
  std::vector<std::function<void()>> calls_;
};

}  // namespace hc::web
