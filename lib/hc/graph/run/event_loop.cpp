// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/event_loop.h>

#include <algorithm>
#include <array>
#include <span>

namespace hc::internal {

Result<std::unique_ptr<EventLoop>> EventLoop::make() {
  auto poll = make_epoll();
  if (!poll) return poll.error();
  return std::unique_ptr<EventLoop>(new EventLoop(std::move(*poll)));
}

EventLoop::Handle EventLoop::add(Entry entry) {
  entries_.emplace(++last_id_, std::make_shared<Entry>(std::move(entry)));
  return {this, last_id_};
}

Result<EventLoop::Handle> EventLoop::watch(int descriptor, std::uint32_t events,
                                           Callback callback) {
  auto handle = add({descriptor, TimePoint::max(), std::move(callback)});
  auto watched = control(poll_, EPOLL_CTL_ADD, descriptor, events, {.u64 = handle.id_});
  if (watched) return handle;
  entries_.at(handle.id_)->descriptor = -1;
  return watched.error();
}

EventLoop::Handle EventLoop::call_at(TimePoint when, Callback callback) {
  auto handle = add({-1, when, std::move(callback)});
  due_.emplace(when, handle.id_);
  return handle;
}

void EventLoop::remove(std::uint64_t id) {
  auto found = entries_.find(id);
  if (found == entries_.end()) return;
  auto entry = found->second;  // what its callback holds may end other watches
  entries_.erase(found);
  due_.erase({entry->due, id});
  if (entry->descriptor >= 0) static_cast<void>(control(poll_, EPOLL_CTL_DEL, entry->descriptor));
}

void EventLoop::call(std::uint64_t id) {
  auto found = entries_.find(id);
  if (found == entries_.end()) return;  // ended by a callback before
  auto entry = found->second;           // may end itself
  entry->callback();
}

void EventLoop::call_due() {
  auto now = std::chrono::steady_clock::now();
  while (!due_.empty() && due_.begin()->first <= now) {
    auto id = due_.begin()->second;
    due_.erase(due_.begin());
    call(id);
  }
}

int EventLoop::milliseconds_left() const {
  using std::chrono::milliseconds;
  if (due_.empty()) return -1;
  auto left =
      std::chrono::ceil<milliseconds>(due_.begin()->first - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp(left, milliseconds(0), milliseconds(1'000'000)).count());
}

Status EventLoop::turn() {
  std::array<epoll_event, 256> events;
  auto count = system_call("epoll_wait", "", [&] {
    return ::epoll_wait(poll_.get(), events.data(), static_cast<int>(events.size()),
                        milliseconds_left());
  });
  if (!count) return count.error();
  for (const auto& event : std::span(events).first(static_cast<std::size_t>(*count)))
    call(event.data.u64);
  call_due();
  return {};
}

}  // namespace hc::internal
