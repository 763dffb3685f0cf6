// SPDX-License-Identifier: Apache-2.0
#pragma once
// The background thread of a process: an event loop that serves links while the program's own
// threads are busy. It starts with the first Watch and never ends; all signals are blocked in it.

#include <cstdint>
#include <memory>

#include <hc/os/loop.h>

namespace hc {

/// A descriptor watched by the background thread, with a timer.
///
///     Watch watch;
///     if (auto started = watch.start(socket, [&](std::uint32_t events) { … }); !started) …
///     watch.want(EPOLLOUT);                  // until want(0), while there is room
///     watch.call_at(now + milliseconds(1));  // once, with events 0
///
/// A callback must not block, since it delays those of all links. It may use any Watch, also its
/// own while that is being destroyed, and may end its own. want() and call_at() may be called on
/// any thread.
class Watch {
 public:
  using TimePoint = Loop::TimePoint;
  using Callback = Loop::Callback;

  Watch() = default;
  ~Watch() { end(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// Call it once, before all other functions.
  /// @param descriptor  must stay open as long as the watch; -1: only a timer.
  ///
  /// Errors: System (no descriptor or thread available).
  Status start(int descriptor, Callback callback);

  /// Removes the callback; waits for a running one to return, unless called from it. Do not call it
  /// while holding a lock that the callback takes.
  void end();

  /// As in Loop::Handle. Cost: a system call if the events or the earliest timer change.
  Status want(std::uint32_t events);
  void move_to(int descriptor);
  void call_at(TimePoint when);

 private:
  struct State;
  class Reactor;

  std::shared_ptr<State> state_;
};

}  // namespace hc
