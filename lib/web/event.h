// SPDX-License-Identifier: Apache-2.0
#pragma once
// How the threads of this module speak to one another.

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <functional>

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

}  // namespace hc::web
