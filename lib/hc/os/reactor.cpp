// SPDX-License-Identifier: Apache-2.0
#include <hc/os/reactor.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

#include <hc/os/thread.h>

namespace hc {

struct Watch::State {
  Loop::Callback callback;
  Loop::Handle handle;  // guarded by the reactor's mutex
  std::atomic<bool> has_ended{false};
};

/// A loop turned by one thread, which releases the mutex while it waits or calls back.
class Watch::Reactor {
 public:
  /// Never destroyed: its thread outlives main().
  static Reactor& the() {
    static auto* reactor = new Reactor;
    return *reactor;
  }

  Status add(State& state, int descriptor, Loop::Callback callback) {
    std::lock_guard lock(mutex);
    if (loop_ == nullptr) {
      auto loop = HC_TRY(Loop::make());
      auto thread = HC_TRY(start_thread([this] { run(); }));  // waits for the mutex
      thread_ = thread.get_id();
      thread.detach();
      loop_ = std::move(loop);
    }
    state.handle = std::move(*loop_->watch(descriptor, 0, std::move(callback)));
    return {};
  }

  void remove(State& state) {
    Loop::Callback callback;  // destroyed after the lock: it may own other watches
    std::unique_lock lock(mutex);
    state.has_ended = true;
    state.handle.reset();
    if (std::this_thread::get_id() != thread_)
      returned_.wait(lock, [&] { return running_ != &state; });
    if (running_ != &state) callback.swap(state.callback);
  }

  /// The loop keeps the callback that is running, and with it `state`, until it returns.
  void call(State& state, std::uint32_t events) {
    if (state.has_ended) return;
    running_ = &state;
    lock_.unlock();
    state.callback(events);
    if (state.has_ended) state.callback = nullptr;  // unlocked, as in remove()
    lock_.lock();
    running_ = nullptr;
    returned_.notify_all();
  }

  std::mutex mutex;

 private:
  [[noreturn]] void run() {
    lock_ = std::unique_lock(mutex);
    while (true) {
      lock_.unlock();
      static_cast<void>(wait_for(loop_->descriptor(), POLLIN, -1));
      lock_.lock();
      static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
    }
  }

  std::unique_lock<std::mutex> lock_;  // used by the thread
  std::condition_variable returned_;   // signalled when a callback returns
  std::thread::id thread_;
  std::unique_ptr<Loop> loop_;
  const State* running_ = nullptr;
};

Status Watch::start(int descriptor, Callback callback) {
  auto state = std::make_shared<State>();
  state->callback = std::move(callback);
  auto added = Reactor::the().add(
      *state, descriptor, [state](std::uint32_t events) { Reactor::the().call(*state, events); });
  if (added) state_ = std::move(state);
  return added;
}

void Watch::end() {
  if (state_ != nullptr) Reactor::the().remove(*state_);
}

Status Watch::want(std::uint32_t events) {
  std::lock_guard lock(Reactor::the().mutex);
  return state_->has_ended ? Status() : state_->handle.want(events);
}

void Watch::move_to(int descriptor) {
  std::lock_guard lock(Reactor::the().mutex);
  if (!state_->has_ended) state_->handle.move_to(descriptor);
}

void Watch::call_at(TimePoint when) {
  std::lock_guard lock(Reactor::the().mutex);
  if (!state_->has_ended) state_->handle.call_at(when);
}

}  // namespace hc
