// SPDX-License-Identifier: Apache-2.0
#pragma once
// The event loop: waits for descriptors and times, and calls back. Single-threaded except
// Loop::post(), with which other threads call functions on the loop's thread; run_aside() (aside.h)
// runs lengthy work on another thread, and reactor.h runs a loop on a background thread. The cost
// of an event does not depend on the number of descriptors.

#include <sys/epoll.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include <hc/os/descriptor.h>

namespace hc {

/// An epoll instance with a timer. It can be nested: descriptor() is readable when turn() has work.
///
///     auto loop = Loop::make();
///     auto watch = (*loop)->watch(socket, EPOLLIN, [&](std::uint32_t) { read(); });
///     auto timer = (*loop)->call_at(now + 1s, [&] { … });
///     while (…) (*loop)->turn();
class Loop {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  /// Takes epoll's events, or 0 when a timer expires.
  using Callback = std::function<void(std::uint32_t events)>;

  /// A registered callback; destroying the handle, also within a callback, removes it.
  class Handle {
   public:
    Handle() = default;
    Handle(Handle&& other) noexcept : loop_(std::exchange(other.loop_, nullptr)), id_(other.id_) {}
    Handle& operator=(Handle&& other) noexcept {
      std::swap(loop_, other.loop_);
      std::swap(id_, other.id_);
      return *this;
    }
    ~Handle() { reset(); }
    void reset() {
      if (auto* loop = std::exchange(loop_, nullptr)) loop->remove(id_);
    }
    explicit operator bool() const { return loop_ != nullptr; }

    /// Sets the events to wait for (level-triggered unless EPOLLET is among them), with hang-up and
    /// error; 0: none, not even these.
    ///
    /// Errors: System (no memory; a descriptor that epoll cannot wait for).
    Status want(std::uint32_t events) { return loop_->want(id_, events); }
    /// Watches another descriptor from now on, at first for no events; -1: none. Call it before the
    /// old descriptor is closed.
    void move_to(int descriptor) { loop_->move(id_, descriptor); }
    /// Calls the callback once with events 0, at `when` or at an earlier time already set.
    void call_at(TimePoint when) { loop_->set_due(id_, when); }

   private:
    friend class Loop;
    Handle(Loop* loop, std::uint64_t id) : loop_(loop), id_(id) {}

    Loop* loop_ = nullptr;
    std::uint64_t id_ = 0;
  };

  /// Errors: System.
  static Result<std::unique_ptr<Loop>> make();

  /// Calls `callback` in each turn in which the descriptor has one of `events`, a hang-up or an
  /// error. The descriptor must stay open as long as the handle; -1: only for Handle::call_at().
  ///
  /// Errors: System.
  Result<Handle> watch(int descriptor, std::uint32_t events, Callback callback);

  /// Calls `callback` once, in the first turn at or after `when`.
  Handle call_at(TimePoint when, std::function<void()> callback);

  /// Calls `job` on the loop's thread in a later turn, in the order of the calls. May be called on
  /// any thread while the loop exists.
  void post(std::function<void()> job);

  /// Waits up to `timeout` (-1: no limit) for events and timers, and calls their callbacks.
  /// Errors: System.
  Status turn(std::chrono::milliseconds timeout = std::chrono::milliseconds(-1));

  [[nodiscard]] int descriptor() const { return poll_.get(); }

 private:
  struct Entry {
    int descriptor = -1;
    Callback callback;
    std::uint32_t wanted = 0;
    TimePoint due = TimePoint::max();
  };

  Loop(Descriptor poll, Descriptor timer) : poll_(std::move(poll)), timer_(std::move(timer)) {}

  Status control(int operation, int descriptor, std::uint32_t events, std::uint64_t id) const;
  Status want(std::uint64_t id, std::uint32_t events);
  void move(std::uint64_t id, int descriptor);
  void set_due(std::uint64_t id, TimePoint when);
  void set_timer(TimePoint when);
  void arm(TimePoint when) const;
  void remove(std::uint64_t id);
  void call_due();
  void do_posted();
  [[nodiscard]] TimePoint next_due() const {
    return due_.empty() ? TimePoint::max() : due_.begin()->first;
  }

  Descriptor poll_, timer_;
  TimePoint timer_due_ = TimePoint::max();  // the time that timer_ is set to
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::shared_ptr<Entry>> entries_;
  std::set<std::pair<TimePoint, std::uint64_t>> due_;
  std::mutex mutex_;                           // guards posted_ and setting timer_
  std::vector<std::function<void()>> posted_;  // unless it is empty, timer_ has expired
};

}  // namespace hc
