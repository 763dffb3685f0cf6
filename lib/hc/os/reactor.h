// SPDX-License-Identifier: Apache-2.0
#pragma once
// The one background thread of a process: it turns an event loop that serves links while the
// program's own threads do other things.
// It starts with the first Watch and never ends; every signal is blocked in it.

#include <cstdint>
#include <memory>

#include <hc/os/loop.h>

namespace hc {

/// A descriptor that the thread watches, and a timer with it.
///
///     Watch watch;
///     if (auto started = watch.start(socket, [&](std::uint32_t events) { … }); !started) …
///     watch.want(EPOLLOUT);                  // until want(0), as long as there is room
///     watch.call_at(now + milliseconds(1));  // once, with events 0
///
/// A callback must not block: those of all links take turns. It may use every Watch, its own also
/// while that is being destroyed, and end its own. want() and call_at() may be called from any
/// thread.
class Watch {
 public:
  using TimePoint = Loop::TimePoint;
  using Callback = Loop::Callback;

  Watch() = default;
  ~Watch() { end(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// To be called once, before all else.
  /// @param descriptor  must stay open as long as the watch; -1: a timer alone.
  ///
  /// Errors: System (no descriptor or thread to be had).
  Status start(int descriptor, Callback callback);

  /// Afterwards the callback neither runs nor will run: waits for it where it runs now, but for
  /// itself. Not to be called, then, while holding a lock which the callback takes.
  void end();

  /// As Loop::Handle's. Cost: a system call where something changes, or the next time of all does.
  Status want(std::uint32_t events);
  void move_to(int descriptor);
  void call_at(TimePoint when);

 private:
  struct State;
  class Reactor;

  std::shared_ptr<State> state_;
};

}  // namespace hc
