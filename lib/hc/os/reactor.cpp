// SPDX-License-Identifier: Apache-2.0
#include <hc/os/reactor.h>

#include <sys/eventfd.h>

#include <array>
#include <condition_variable>
#include <csignal>
#include <map>
#include <mutex>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <hc/os/epoll.h>

namespace hc::internal {
namespace {

using TimePoint = Watch::TimePoint;
constexpr TimePoint kNever = TimePoint::max();
constexpr std::uint64_t kWakeId = 0;  // of the event that ends a wait; watches have others

struct Entry {
  int descriptor = -1;
  Watch::Callback callback;
  std::uint32_t wanted = 0;
  TimePoint due = kNever;
};

/// What the thread and the watches share. Callbacks run without the lock.
class Reactor {
 public:
  Status start() {
    std::lock_guard lock(mutex_);
    if (started_) return {};
    auto poll = make_epoll();
    if (!poll) return poll.error();
    poll_ = std::move(*poll);
    auto wake = system_call("eventfd", "", [] { return ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC); });
    if (!wake) return wake.error();
    wake_ = Descriptor(*wake);
    if (auto watched = control(poll_, EPOLL_CTL_ADD, wake_.get(), EPOLLIN, {.u64 = kWakeId});
        !watched)
      return watched;
    return start_thread();
  }

  std::uint64_t add(int descriptor, Watch::Callback callback) {
    auto entry = std::make_shared<Entry>();
    entry->descriptor = descriptor;
    entry->callback = std::move(callback);
    std::lock_guard lock(mutex_);
    entries_.emplace(++last_id_, std::move(entry));
    return last_id_;
  }

  void remove(std::uint64_t id) {
    std::shared_ptr<Entry> entry;  // goes without the lock: it may hold watches of its own
    std::unique_lock lock(mutex_);
    entry = std::move(entries_.at(id));  // lives on while its own callback runs
    entries_.erase(id);
    due_.erase({entry->due, id});
    if (entry->wanted != 0) static_cast<void>(control(poll_, EPOLL_CTL_DEL, entry->descriptor));
    if (std::this_thread::get_id() == thread_) return;
    returned_.wait(lock, [&] { return running_ != id; });
  }

  Status want(std::uint64_t id, std::uint32_t events) {
    std::lock_guard lock(mutex_);
    auto found = entries_.find(id);
    if (found == entries_.end()) return {};  // it ends, and waits for the callback that asks
    Entry& entry = *found->second;
    if (events == entry.wanted && (events & EPOLLONESHOT) == 0) return {};
    int operation = events == 0 ? EPOLL_CTL_DEL : entry.wanted == 0 ? EPOLL_CTL_ADD : EPOLL_CTL_MOD;
    auto done = control(poll_, operation, entry.descriptor, events, {.u64 = id});
    if (done) entry.wanted = events;
    return done;
  }

  void call_at(std::uint64_t id, TimePoint when) {
    std::lock_guard lock(mutex_);
    auto found = entries_.find(id);
    if (found == entries_.end() || found->second->due <= when) return;
    Entry& entry = *found->second;
    due_.erase({entry.due, id});
    entry.due = when;
    bool is_next = due_.empty() || when < due_.begin()->first;
    due_.emplace(when, id);
    if (is_next && std::this_thread::get_id() != thread_) ::eventfd_write(wake_.get(), 1);
  }

 private:
  Status start_thread() {
    // A signal is for the threads that know what to do about it.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    Status begun;
    try {
      std::thread thread([this] { run(); });
      thread_ = thread.get_id();
      thread.detach();
      started_ = true;
    } catch (const std::system_error& error) {
      begun = Error{Code::System, std::string("thread: ") + error.what()};
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return begun;
  }

  [[noreturn]] void run() {
    std::array<epoll_event, 64> events;
    std::unique_lock lock(mutex_);
    while (true) {
      timespec left{};
      const timespec* timeout = due_.empty() ? nullptr : &left;
      if (timeout != nullptr) left = time_until(due_.begin()->first);
      lock.unlock();
      int count = ::epoll_pwait2(poll_.get(), events.data(), static_cast<int>(events.size()),
                                 timeout, nullptr);
      auto now = std::chrono::steady_clock::now();
      lock.lock();
      for (int i = 0; i < count; ++i) {
        const auto& event = events.at(static_cast<std::size_t>(i));
        if (event.data.u64 == kWakeId)
          lower();
        else
          tell(lock, event.data.u64, event.events);
      }
      while (!due_.empty() && due_.begin()->first <= now) {
        auto id = due_.begin()->second;
        entries_.at(id)->due = kNever;
        due_.erase(due_.begin());
        call(lock, id, 0);
      }
    }
  }

  static timespec time_until(TimePoint when) {
    using std::chrono::nanoseconds;
    auto left = std::max(nanoseconds(0), nanoseconds(when - std::chrono::steady_clock::now()));
    return {left.count() / std::nano::den, left.count() % std::nano::den};
  }

  void lower() const {
    eventfd_t count = 0;
    ::eventfd_read(wake_.get(), &count);
  }

  /// Tells of events, but of none that is not wanted any more.
  void tell(std::unique_lock<std::mutex>& lock, std::uint64_t id, std::uint32_t events) {
    auto found = entries_.find(id);
    if (found == entries_.end() || found->second->wanted == 0) return;
    events &= found->second->wanted | EPOLLERR | EPOLLHUP;
    if (events != 0) call(lock, id, events);
  }

  void call(std::unique_lock<std::mutex>& lock, std::uint64_t id, std::uint32_t events) {
    auto entry = entries_.at(id);
    running_ = id;
    lock.unlock();
    entry->callback(events);
    entry.reset();  // what the callback holds may be watches of its own
    lock.lock();
    running_ = kWakeId;
    returned_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable returned_;  // from a callback
  bool started_ = false;
  std::thread::id thread_;
  Descriptor poll_, wake_;
  std::uint64_t last_id_ = kWakeId, running_ = kWakeId;
  std::map<std::uint64_t, std::shared_ptr<Entry>> entries_;
  std::set<std::pair<TimePoint, std::uint64_t>> due_;
};

/// Never destroyed: its thread outlives main().
Reactor& reactor() {
  static auto* the = new Reactor;
  return *the;
}

}  // namespace

Result<std::unique_ptr<Watch>> Watch::make(int descriptor, Callback callback) {
  if (auto started = reactor().start(); !started) return started.error();
  return std::unique_ptr<Watch>(new Watch(reactor().add(descriptor, std::move(callback))));
}

Watch::~Watch() {
  reactor().remove(id_);
}

Status Watch::want(std::uint32_t events) {
  return reactor().want(id_, events);
}

void Watch::call_at(TimePoint when) {
  reactor().call_at(id_, when);
}

}  // namespace hc::internal
