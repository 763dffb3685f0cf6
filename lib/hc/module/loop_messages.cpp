// SPDX-License-Identifier: Apache-2.0
// A module's loop by the clock of its messages (--clock messages): the messages of all links in the
// order of their times, and what is due between them. What the module does is then a matter of what
// it is fed with, not of how fast it is fed. With the trace of an earlier run as the clock, it does
// the same at the same moments.
#include <algorithm>
#include <optional>
#include <utility>

#include <hc/module/loop.h>
#include <hc/os/program.h>

namespace hc {
namespace {

using internal::Stopped;

/// A longer time without any message is passed at once, as periods that were missed are not made up
/// for: or one wrong time would have the module do what is due in years.
constexpr MonotonicTime kLongestGap = std::chrono::hours(1);

}  // namespace

/// Has the next message of each link at hand; whether that could be done without waiting.
bool Module::Loop::has_heads() {
  bool all = true;
  Message message;
  inlets_.for_each([&](internal::Inlet& inlet) {
    if (!inlet.is_open()) return;
    const auto got = inlets_.take(inlet, message);
    if (got == Got::Message) inlet.head = message.keep();
    if (got == Got::Nothing) all = false;
  });
  return all;
}

/// The link whose next message is the earliest; of equal times, the focus, then the first. Null:
/// none has any.
internal::Inlet* Module::Loop::earliest() {
  internal::Inlet* first = nullptr;
  inlets_.for_each([&](internal::Inlet& inlet) {
    if (inlet.head && (first == nullptr || inlet.time() < first->time())) first = &inlet;
  });
  return first;
}

/// The clock begins with the trace, or the first message that has a time.
void Module::Loop::begin_clock() {
  if (moments_ && !moments_->empty()) return now_.pass_to(MonotonicTime(moments_->front().moment));
  while (!has_heads()) {
    if (stop_requested()) throw Stopped();
    wait(true, MonotonicTime::max());
    now_.read();
    attend();
  }
  std::optional<std::int64_t> first;
  inlets_.for_each([&](const internal::Inlet& inlet) {
    const auto time = inlet.head ? inlet.head->header.time : 0;
    if (time != 0) first = std::min(first.value_or(time), time);
  });
  if (first) now_.pass_to(MonotonicTime(*first));
}

/// Handles the earliest message if its time has come, else lets time pass to what is due next.
/// False when a message is to be waited for, the generator is next, or none comes any more.
bool Module::Loop::take_earliest() {
  generates_next_ = false;
  if (!has_heads()) return false;
  if (inlets_.all_ended()) {
    generates_next_ = !std::exchange(has_ended_, true);
    return false;
  }
  internal::Inlet* inlet = earliest();
  if (inlet == nullptr) return false;  // none is linked yet
  // One without a time, or that is late, comes now.
  const auto due = std::max(MonotonicTime(inlet->head->header.time), now_.time());
  if (due - now_.time() > kLongestGap) {
    now_.pass_to(due);
    return true;
  }
  if (const auto timer = timers_.next(); timer > now_.time() && timer <= due) {
    now_.pass_to(timer);
    return true;
  }
  if (module_.generate_ && due > now_.time() && !has_generated_) {
    generates_next_ = true;
    return false;
  }
  now_.pass_to(due);
  delivery_.expire_focus();
  has_generated_ = false;
  Message message = *std::exchange(inlet->head, std::nullopt);
  delivery_.handle(*inlet, message);
  inlets_.sets().handle_newest();
  return true;
}

bool Module::Loop::is_generators_turn() const {
  return module_.generate_ && (!module_.message_time_ || generates_next_);
}

/// False at its end.
bool Module::Loop::generate() {
  has_generated_ = true;
  return module_.generate_();
}

/// Reads what the module is to do again: what it began, and when.
void Module::Loop::read_moments(const Uri& uri) {
  const auto source = opener_.open(uri, "clock");
  moments_.emplace();
  Message message;
  while (true) {
    const auto any = receive(*source, message);
    if (!any) internal::fail(uri.text(), any.error());
    if (!*any) return;
    for (auto& event : read_trace(message)) moments_->push_back(std::move(event));
  }
}

/// Does what the module did next, at that moment; false when there is no more.
bool Module::Loop::repeat_next() {
  if (moments_->empty()) return false;
  if (!has_heads()) {
    wait(true, MonotonicTime::max());
    return true;
  }
  const TraceEvent event = std::move(moments_->front());
  moments_->pop_front();
  if (event.what != TraceEvent::What::Began) return true;
  now_.pass_to(std::max(now_.time(), MonotonicTime(event.moment)));
  delivery_.expire_focus();
  if (event.port.empty()) {
    repeat_without_message(event.number);
    return true;
  }
  internal::Inlet* found = nullptr;
  inlets_.for_each([&](internal::Inlet& inlet) {
    if (found == nullptr && inlet.head && inlet.number == event.number &&
        inlet.port() == event.port)
      found = &inlet;
  });
  if (found == nullptr) return true;
  Message message = *std::exchange(found->head, std::nullopt);
  delivery_.handle(*found, message);
  return true;
}

/// Calls a timer, a time-out or the generator; a module that was changed may have fewer.
void Module::Loop::repeat_without_message(std::int32_t number) {
  if (number == TraceEvent::kGenerator) {
    if (module_.generate_ && !generate()) moments_->clear();
  } else {
    timers_.fire(static_cast<std::size_t>(number));
  }
}

}  // namespace hc
