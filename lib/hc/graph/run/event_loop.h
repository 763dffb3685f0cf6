// SPDX-License-Identifier: Apache-2.0
#pragma once
// Waits for descriptors and times, and calls who asked; on one thread. Internal to graph.
// Time for an event does not grow with what else is watched.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <hc/os/epoll.h>

namespace hc::internal {

/// Calls back for what is watched.
///
///     auto loop = EventLoop::make();
///     auto watch = (*loop)->watch(socket, EPOLLIN, [&] { read(); });
///     auto timer = (*loop)->call_at(now + 1s, [&] { … });
///     while (…) (*loop)->turn();
class EventLoop {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Callback = std::function<void()>;

  /// A wish to be called; it ends with this object, also within a callback.
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

   private:
    friend class EventLoop;
    Handle(EventLoop* loop, std::uint64_t id) : loop_(loop), id_(id) {}

    EventLoop* loop_ = nullptr;
    std::uint64_t id_ = 0;
  };

  /// Errors: System.
  static Result<std::unique_ptr<EventLoop>> make();

  /// Has `callback` called in each turn in which the descriptor has `events` (EPOLLIN, EPOLLOUT),
  /// or is at its end. The descriptor is to stay open until the handle has gone.
  ///
  /// Errors: System.
  Result<Handle> watch(int descriptor, std::uint32_t events, Callback callback);

  /// Has `callback` called once, in the first turn at or after that time.
  Handle call_at(TimePoint when, Callback callback);

  /// Waits for the next event or time, and calls all whose turn it is. Errors: System.
  Status turn();

 private:
  struct Entry {
    int descriptor = -1;
    TimePoint due = TimePoint::max();
    Callback callback;
  };

  explicit EventLoop(Descriptor poll) : poll_(std::move(poll)) {}

  Handle add(Entry entry);
  void remove(std::uint64_t id);
  void call(std::uint64_t id);
  void call_due();
  [[nodiscard]] int milliseconds_left() const;

  Descriptor poll_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::shared_ptr<Entry>> entries_;
  std::set<std::pair<TimePoint, std::uint64_t>> due_;
};

}  // namespace hc::internal
