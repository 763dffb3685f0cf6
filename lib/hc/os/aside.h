// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs lengthy work on a thread beside an event loop.

#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

#include <hc/os/descriptor.h>
#include <hc/os/detached.h>
#include <hc/os/event.h>
#include <hc/os/loop.h>
#include <hc/os/thread.h>

namespace hc {

/// Work that run_aside() has started. Destroy it on the loop's thread or after the loop's last
/// turn.
class Aside {
 public:
  Aside() = default;  ///< no work
  Aside(Aside&&) = default;
  Aside& operator=(Aside&& other) noexcept {
    std::swap(state_, other.state_);
    return *this;
  }
  /// Asks the work to stop and waits for it. Its result is discarded.
  ~Aside();

  /// Whether the result has not been passed to `done` yet.
  [[nodiscard]] bool is_busy() const { return state_ && state_->thread.joinable(); }
  /// Asks the work in progress, if any, to stop; its result is still passed to `done`.
  void stop();
  [[nodiscard]] bool is_stopped() const { return state_ && state_->is_stopped; }

 private:
  template <typename Work, typename Done>
  friend Result<Aside> run_aside(Loop& loop, Work work, Done done);

  struct State {
    Event stop;
    bool is_stopped = false;
    std::function<void()> done;
    std::thread thread;
  };

  static Result<Aside> begin(Loop& loop, std::function<void(int stop)> work,
                             std::function<void()> done);

  std::shared_ptr<State> state_;
};

/// Calls `work(stop)` on a new thread with all signals blocked, and then `done(result)` on the
/// loop's thread. `work` returns a value, early if the descriptor `stop` becomes readable.
///
///     aside_ = run_aside(loop, [](int stop) { return load(stop); }, [this](Loaded it) { … });
///
/// Errors: System (no descriptor or thread available).
template <typename Work, typename Done>
[[nodiscard]] Result<Aside> run_aside(Loop& loop, Work work, Done done) {
  auto result = std::make_shared<std::optional<std::invoke_result_t<Work&, int>>>();
  return Aside::begin(
      loop, [result, work = std::move(work)](int stop) mutable { result->emplace(work(stop)); },
      [result, done = std::move(done)]() mutable { done(std::move(**result)); });
}

/// The result of `work()`, which returns a Result and may block indefinitely; see Detached. It is
/// abandoned if `stop` becomes readable.
///
///     auto text = unless_stopped(stop, [name] { return read_text(name); });
///
/// Errors: Stopped; System (no descriptor or thread available); those of `work`.
template <typename Work>
[[nodiscard]] std::invoke_result_t<Work&> unless_stopped(int stop, Work work) {
  auto detached = HC_TRY(Detached<std::invoke_result_t<Work&>>::begin(std::move(work)));
  HC_TRY(wait_for(detached.descriptor(), POLLIN, stop));
  return std::move(*detached.take());
}

}  // namespace hc
