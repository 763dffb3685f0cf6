// SPDX-License-Identifier: Apache-2.0
#pragma once
// Work that may take its time, done beside a loop. Internal to graph.

#include <functional>
#include <memory>
#include <thread>

#include <hc/os/event.h>
#include <hc/os/loop.h>

namespace hc::internal {

/// Does one piece of work at a time on a thread of its own, while the loop continues.
class Aside {
 public:
  /// Ends as soon as it can when the descriptor `stop` is readable.
  using Work = std::function<void(int stop)>;

  /// Errors: System.
  static Result<std::unique_ptr<Aside>> make(Loop& loop);
  /// Has the work stop, and waits for that. What follows it is not called any more.
  ~Aside();
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;

  /// Begins work when there is none; `done` is called in the turn of the loop that follows it.
  void begin(Work work, std::function<void()> done);
  /// Asks the work in progress, if any, to stop; `done` is called all the same.
  void stop();
  [[nodiscard]] bool is_busy() const { return thread_.joinable(); }
  [[nodiscard]] bool is_stopped() const { return is_stopped_; }

 private:
  Aside(Event stop, Event ended) : stop_(std::move(stop)), ended_(std::move(ended)) {}

  void finish();

  Event stop_, ended_;
  bool is_stopped_ = false;
  std::function<void()> done_;
  Loop::Handle watch_;
  std::thread thread_;
};

}  // namespace hc::internal
