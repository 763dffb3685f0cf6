// SPDX-License-Identifier: Apache-2.0
#pragma once
// A flag that threads can poll.

#include <sys/eventfd.h>

#include <utility>

#include <hc/os/descriptor.h>

namespace hc {

/// An eventfd: readable from raise() to clear(), both of which any thread may call.
class Event {
 public:
  Event() = default;  ///< no event: its descriptor is -1, and waiting for it never returns
  /// Errors: System.
  static Result<Event> make() {
    auto made = HC_TRY(
        open_descriptor("eventfd", "", [] { return ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC); }));
    return Event(std::move(made));
  }

  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  void raise() const { ::eventfd_write(descriptor_.get(), 1); }
  /// Whether it was raised.
  bool clear() const {
    eventfd_t count = 0;
    return ::eventfd_read(descriptor_.get(), &count) == 0;
  }

 private:
  explicit Event(Descriptor descriptor) : descriptor_(std::move(descriptor)) {}

  Descriptor descriptor_;
};

}  // namespace hc
