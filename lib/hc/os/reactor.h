// SPDX-License-Identifier: Apache-2.0
#pragma once
// The one thread of a process that serves links while the program's own threads do other things:
// it waits for descriptors and for times, and calls who asked. Internal.
// It begins with the first Watch and never ends; every signal is blocked in it.

#include <sys/epoll.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>

#include <hc/base/result.h>

namespace hc::internal {

/// A descriptor that the thread looks after, and a timer with it.
///
///     auto watch = Watch::make(socket, [&](std::uint32_t events) { … });
///     if (!watch) return watch.error();
///     (*watch)->want(EPOLLOUT);                  // until want(0), as long as there is room
///     (*watch)->call_at(now + milliseconds(1));  // once, with events 0
///
/// A callback is not to wait: those of all links take turns. It may use every Watch, and destroy
/// its own. want() and call_at() may be called from any thread.
class Watch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  /// Takes epoll's events, or 0 when it is time.
  using Callback = std::function<void(std::uint32_t events)>;

  /// @param descriptor  is to stay open for as long as the watch lives; -1: a timer alone. One that
  ///     epoll cannot wait for, as a file, is the caller's error.
  ///
  /// Errors: System (no descriptor or thread to be had).
  static Result<std::unique_ptr<Watch>> make(int descriptor, Callback callback);

  /// Afterwards the callback neither runs nor will run: waits for it where it runs now, but for
  /// itself. Not to be destroyed, then, while holding a lock which the callback takes.
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// Has the descriptor watched for EPOLLIN, EPOLLOUT and the like, level-triggered, until the next
  /// want(); with any of them for hang-up and error too, and with EPOLLERR for these alone.
  /// 0: for nothing; with EPOLLONESHOT, once. Cost: a system call where something changes.
  ///
  /// Errors: System (no memory; a descriptor that epoll cannot wait for).
  Status want(std::uint32_t events);

  /// Has the callback called once at `when`, or earlier if an earlier call is due already.
  /// Cost: wakes the thread when this is the next time of all.
  void call_at(TimePoint when);

 private:
  explicit Watch(std::uint64_t id) : id_(id) {}

  std::uint64_t id_;
};

}  // namespace hc::internal
