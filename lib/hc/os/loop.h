// SPDX-License-Identifier: Apache-2.0
#pragma once
// The event loop: waits for descriptors and times, and calls back. Loop::post() is the way to its
// thread from any other, run_aside() (aside.h) from it to one for work that takes its time.
// The rest is used from one thread; reactor.h runs a loop on a thread of its own. The
// cost of an event does not grow with what else is watched.

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

/// An epoll instance with a timer in it. It can be nested: descriptor() is readable when turn() has
/// something to do.
///
///     auto loop = Loop::make();
///     auto watch = (*loop)->watch(socket, EPOLLIN, [&](std::uint32_t) { read(); });
///     auto timer = (*loop)->call_at(now + 1s, [&] { … });
///     while (…) (*loop)->turn();
class Loop {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  /// Takes epoll's events, or 0 when a time has come.
  using Callback = std::function<void(std::uint32_t events)>;

  /// A callback that is registered until this object ends, which it may do within a callback.
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

    /// Has the descriptor watched for these events from now on (level-triggered unless EPOLLET is
    /// among them), and for hang-up and error; 0: for nothing.
    ///
    /// Errors: System (no memory; a descriptor that epoll cannot wait for).
    Status want(std::uint32_t events) { return loop_->want(id_, events); }
    /// Has another descriptor watched from now on, for nothing yet. To be called before the one
    /// there is is closed; -1: none.
    void move_to(int descriptor) { loop_->move(id_, descriptor); }
    /// Has the callback called once with events 0, at `when` or at an earlier time set before.
    void call_at(TimePoint when) { loop_->set_due(id_, when); }

   private:
    friend class Loop;
    Handle(Loop* loop, std::uint64_t id) : loop_(loop), id_(id) {}

    Loop* loop_ = nullptr;
    std::uint64_t id_ = 0;
  };

  /// Errors: System.
  static Result<std::unique_ptr<Loop>> make();

  /// Has `callback` called in each turn in which the descriptor has one of `events`, a hang-up or
  /// an error. The descriptor must stay open as long as the handle. -1: for Handle::call_at()
  /// alone.
  ///
  /// Errors: System.
  Result<Handle> watch(int descriptor, std::uint32_t events, Callback callback);

  /// Has `callback` called once, in the first turn at or after that time.
  Handle call_at(TimePoint when, std::function<void()> callback);

  /// Has `job` called in the loop's thread, in a later turn; jobs keep their order. From any
  /// thread, while the loop exists.
  void post(std::function<void()> job);

  /// Waits for the next event or time, at most `timeout` (-1: for ever), and calls back for all.
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
  TimePoint timer_due_ = TimePoint::max();  // what timer_ is set to
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::shared_ptr<Entry>> entries_;
  std::set<std::pair<TimePoint, std::uint64_t>> due_;
  std::mutex mutex_;                           // of what follows, and of setting timer_
  std::vector<std::function<void()>> posted_;  // while there are any, timer_ is due
};

}  // namespace hc
