// SPDX-License-Identifier: Apache-2.0
#include <hc/os/loop.h>

#include <sys/timerfd.h>

#include <algorithm>
#include <array>
#include <span>

namespace hc {

constexpr std::uint64_t kTimerId = 0;  // the ids of entries start at 1

Result<std::unique_ptr<Loop>> Loop::make() {
  auto poll =
      HC_TRY(open_descriptor("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); }));
  auto timer = HC_TRY(open_descriptor("timerfd_create", "", [] {
    return ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  }));
  std::unique_ptr<Loop> loop(new Loop(std::move(poll), std::move(timer)));
  HC_TRY(loop->control(EPOLL_CTL_ADD, loop->timer_.get(), EPOLLIN, kTimerId));
  return loop;
}

Status Loop::control(int operation, int descriptor, std::uint32_t events, std::uint64_t id) const {
  epoll_event event{events, {.u64 = id}};
  HC_TRY(system_call("epoll_ctl", "",
                     [&] { return ::epoll_ctl(poll_.get(), operation, descriptor, &event); }));
  return {};
}

Result<Loop::Handle> Loop::watch(int descriptor, std::uint32_t events, Callback callback) {
  entries_.emplace(++last_id_, std::make_shared<Entry>(Entry{descriptor, std::move(callback)}));
  Handle handle(this, last_id_);
  HC_TRY(want(last_id_, events));
  return handle;
}

Loop::Handle Loop::call_at(TimePoint when, std::function<void()> callback) {
  Handle handle = std::move(*watch(-1, 0, [call = std::move(callback)](auto) { call(); }));
  handle.call_at(when);
  return handle;
}

Status Loop::want(std::uint64_t id, std::uint32_t events) {
  Entry& entry = *entries_.at(id);
  if (events == entry.wanted && (events & EPOLLONESHOT) == 0) return {};
  int operation = events == 0 ? EPOLL_CTL_DEL : entry.wanted == 0 ? EPOLL_CTL_ADD : EPOLL_CTL_MOD;
  auto done = control(operation, entry.descriptor, events, id);
  if (done) entry.wanted = events;
  return done;
}

void Loop::move(std::uint64_t id, int descriptor) {
  static_cast<void>(want(id, 0));
  entries_.at(id)->descriptor = descriptor;
}

void Loop::set_due(std::uint64_t id, TimePoint when) {
  Entry& entry = *entries_.at(id);
  if (entry.due <= when) return;
  due_.erase({entry.due, id});
  entry.due = when;
  due_.emplace(when, id);
  if (when < timer_due_) set_timer(when);
}

void Loop::set_timer(TimePoint when) {
  const std::lock_guard lock(mutex_);
  timer_due_ = when;
  arm(posted_.empty() ? when : TimePoint());
}

/// A time in the past makes the timer readable at once.
void Loop::arm(TimePoint when) const {
  using std::chrono::nanoseconds;
  itimerspec spec{};
  if (when != TimePoint::max()) {
    auto since = std::max<nanoseconds>(nanoseconds(1), when.time_since_epoch());
    spec.it_value = {since.count() / std::nano::den, since.count() % std::nano::den};
  }
  ::timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &spec, nullptr);
}

void Loop::remove(std::uint64_t id) {
  const auto entry = entries_.extract(id).mapped();  // its callback may own other handles
  due_.erase({entry->due, id});
  if (entry->due == timer_due_ && entry->due != TimePoint::max()) set_timer(next_due());
  if (entry->wanted != 0) static_cast<void>(control(EPOLL_CTL_DEL, entry->descriptor, 0, id));
}

void Loop::post(std::function<void()> job) {
  const std::lock_guard lock(mutex_);
  posted_.push_back(std::move(job));
  if (posted_.size() == 1) arm(TimePoint());
}

void Loop::do_posted() {
  std::vector<std::function<void()>> jobs;
  {
    const std::lock_guard lock(mutex_);
    jobs.swap(posted_);
  }
  for (const auto& job : jobs) job();
}

void Loop::call_due() {
  const auto now = std::chrono::steady_clock::now();
  while (!due_.empty() && due_.begin()->first <= now) {
    auto entry = entries_.at(due_.begin()->second);  // keeps it if the callback ends its handle
    due_.erase(due_.begin());
    entry->due = TimePoint::max();
    entry->callback(0);
  }
  set_timer(next_due());
}

Status Loop::turn(std::chrono::milliseconds timeout) {
  std::array<epoll_event, 64> events;
  auto count = HC_TRY(system_call("epoll_wait", "", [&] {
    return ::epoll_wait(poll_.get(), events.data(), static_cast<int>(events.size()),
                        static_cast<int>(timeout.count()));
  }));
  bool is_time = false;
  for (const auto& event : std::span(events).first(static_cast<std::size_t>(count))) {
    const std::uint64_t id = event.data.u64;  // a copy, since the event is packed
    is_time = is_time || id == kTimerId;
    auto found = entries_.find(id);
    if (found == entries_.end()) continue;  // removed by an earlier callback of this turn
    auto entry = found->second;             // keeps it if the callback ends its handle
    // An earlier callback may have changed the wanted events.
    auto wanted = entry->wanted == 0 ? 0 : event.events & (entry->wanted | EPOLLERR | EPOLLHUP);
    if (wanted != 0) entry->callback(wanted);
  }
  if (is_time) {
    do_posted();
    call_due();
  }
  return {};
}

}  // namespace hc
