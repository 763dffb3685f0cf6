// SPDX-License-Identifier: Apache-2.0
#include <hc/os/reactor.h>

#include <atomic>
#include <condition_variable>
#include <csignal>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace hc::internal {

struct Watch::State {
  Loop::Callback callback;
  Loop::Handle handle;  // used with the reactor's lock
  std::atomic<bool> has_ended{false};
};

/// A loop, turned by one thread with a lock that is free while the thread waits or calls back.
class Watch::Reactor {
 public:
  Status start() {
    std::lock_guard lock(mutex_);
    if (loop_ != nullptr) return {};
    auto loop = Loop::make();
    if (!loop) return loop.error();
    loop_ = std::move(*loop);
    auto started = start_thread();
    if (!started) loop_.reset();
    return started;
  }

  std::shared_ptr<State> add(int descriptor, Loop::Callback callback) {
    auto state = std::make_shared<State>();
    state->callback = std::move(callback);
    std::lock_guard lock(mutex_);
    state->handle = std::move(
        *loop_->watch(descriptor, 0, [this, state](std::uint32_t events) { call(state, events); }));
    return state;
  }

  void remove(State& state) {
    Loop::Callback callback;  // ends without the lock: it may hold watches of its own
    std::unique_lock lock(mutex_);
    state.has_ended = true;
    state.handle.reset();
    if (std::this_thread::get_id() != thread_)
      returned_.wait(lock, [&] { return running_ != &state; });
    if (running_ != &state) callback.swap(state.callback);
  }

  Status want(State& state, std::uint32_t events) {
    std::lock_guard lock(mutex_);
    return state.has_ended ? Status() : state.handle.want(events);
  }

  void move(State& state, int descriptor) {
    std::lock_guard lock(mutex_);
    if (!state.has_ended) state.handle.move_to(descriptor);
  }

  void call_at(State& state, TimePoint when) {
    std::lock_guard lock(mutex_);
    if (!state.has_ended) state.handle.call_at(when);
  }

 private:
  Status start_thread() {
    // A signal is for the threads that know what to do about it.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    Status started;
    try {
      std::thread thread([this] { run(); });
      thread_ = thread.get_id();
      thread.detach();
    } catch (const std::system_error& error) {
      started = Error{Code::System, std::string("thread: ") + error.what()};
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return started;
  }

  [[noreturn]] void run() {
    lock_ = std::unique_lock(mutex_);
    while (true) {
      lock_.unlock();
      static_cast<void>(wait_for(loop_->descriptor(), POLLIN, -1));
      lock_.lock();
      static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
    }
  }

  void call(const std::shared_ptr<State>& state, std::uint32_t events) {
    if (state->has_ended) return;
    auto held = state;
    running_ = held.get();
    lock_.unlock();
    held->callback(events);
    if (held->has_ended) held->callback = nullptr;  // without the lock, as in remove()
    lock_.lock();
    running_ = nullptr;
    returned_.notify_all();
  }

  std::mutex mutex_;
  std::unique_lock<std::mutex> lock_;  // of the thread
  std::condition_variable returned_;   // from a callback
  std::thread::id thread_;
  std::unique_ptr<Loop> loop_;
  const State* running_ = nullptr;
};

/// Never destroyed: its thread outlives main().
Watch::Reactor& Watch::reactor() {
  static auto* the = new Reactor;
  return *the;
}

Result<std::unique_ptr<Watch>> Watch::make(int descriptor, Callback callback) {
  if (auto started = reactor().start(); !started) return started.error();
  return std::unique_ptr<Watch>(new Watch(reactor().add(descriptor, std::move(callback))));
}

Watch::~Watch() {
  reactor().remove(*state_);
}

Status Watch::want(std::uint32_t events) {
  return reactor().want(*state_, events);
}

void Watch::move_to(int descriptor) {
  reactor().move(*state_, descriptor);
}

void Watch::call_at(TimePoint when) {
  reactor().call_at(*state_, when);
}

}  // namespace hc::internal
