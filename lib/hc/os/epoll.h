// SPDX-License-Identifier: Apache-2.0
#pragma once
// Descriptors that are waited for together: epoll instances, timers for them, and what they watch.
// Internal.

#include <sys/epoll.h>
#include <sys/timerfd.h>

#include <chrono>

#include <hc/os/descriptor.h>

namespace hc::internal {

/// Errors: System.
inline Result<Descriptor> make_epoll() {
  auto made = system_call("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); });
  if (!made) return made.error();
  return Descriptor(*made);
}

/// A timer that is readable once it is time; set_timer() says when. Errors: System.
inline Result<Descriptor> make_timer() {
  auto made = system_call("timerfd_create", "", [] {
    return ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  });
  if (!made) return made.error();
  return Descriptor(*made);
}

/// Sets a timer to a time from now, or to never when that is 0.
inline void set_timer(const Descriptor& timer, std::chrono::nanoseconds left) {
  itimerspec when{};
  when.it_value = {left.count() / std::nano::den, left.count() % std::nano::den};
  ::timerfd_settime(timer.get(), 0, &when, nullptr);
}

/// Adds, changes or removes what an epoll instance watches.
///
/// @param operation  EPOLL_CTL_ADD, EPOLL_CTL_MOD or EPOLL_CTL_DEL.
/// @param data  comes back with the events.
///
/// Errors: System.
inline Status control(const Descriptor& epoll, int operation, int descriptor,
                      std::uint32_t events = 0, epoll_data_t data = {}) {
  epoll_event event{};
  event.events = events;
  event.data = data;
  auto done = system_call("epoll_ctl", "",
                          [&] { return ::epoll_ctl(epoll.get(), operation, descriptor, &event); });
  if (!done) return done.error();
  return {};
}

}  // namespace hc::internal
