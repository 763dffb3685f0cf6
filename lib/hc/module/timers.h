// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's time, its timers and its time-outs. Internal.

#include <algorithm>
#include <cstdint>
#include <optional>

#include <hc/module/module.h>
#include <hc/module/trace.h>

namespace hc {

namespace internal {

/// The time, by the messages' clock or by the machine's, which is read once per message.
struct Now {
  const Clock& clock;
  std::optional<Time>& message_time;        ///< the module's; none: by the machine's clock
  MonotonicTime machine{0};                 ///< when the clock was last read
  std::chrono::nanoseconds wall_offset{0};  ///< from monotonic to wall clock

  [[nodiscard]] MonotonicTime time() const {
    return message_time ? message_time->time_since_epoch() : machine;
  }
  void read() { machine = clock.monotonic(); }
  void read_wall() { wall_offset = clock.wall().time_since_epoch() - clock.monotonic(); }
  /// Sets the clock of the messages.
  void pass_to(MonotonicTime time) {
    message_time = Time(std::clamp(time, MonotonicTime(0), kLatest));
  }
};

}  // namespace internal

/// Timers and time-outs, numbered as in a trace: in order of declaration, time-outs last.
class Module::Timers {
 public:
  Timers(Module& module, internal::Now& now, internal::Trace& trace)
      : module_(module),
        timers_(module.timers_),
        timeouts_(module.timeouts_),
        now_(now),
        trace_(trace) {}

  /// Starts them all.
  void start() {
    for (auto& timer : timers_) timer.last = now_.time();
    for (auto& timeout : timeouts_)
      if (timeout->due) *timeout->due += now_.time();
  }

  /// When the next is due.
  [[nodiscard]] MonotonicTime next() const {
    auto next = MonotonicTime::max();
    for (const auto& timer : timers_) next = std::min(next, timer.due());
    for (const auto& timeout : timeouts_)
      if (timeout->due) next = std::min(next, *timeout->due);
    return next;
  }

  void fire_due() {
    for (std::size_t i = 0; i < timers_.size() && !module_.is_done_; ++i) {
      auto& timer = timers_[i];
      const auto due = timer.due();
      if (due > now_.time()) continue;
      fire_traced(i);
      timer.last = std::max(due, now_.time() - timer.period());
    }
    // A handler may add some.
    for (std::size_t i = 0; i < timeouts_.size() && !module_.is_done_; ++i)
      if (timeouts_[i]->due && *timeouts_[i]->due <= now_.time()) fire_traced(timers_.size() + i);
  }

  /// Fires one, if it exists.
  void fire(std::size_t number) {
    if (number < timers_.size()) return timers_[number].handler();
    if (number - timers_.size() >= timeouts_.size()) return;
    const auto timeout = timeouts_[number - timers_.size()];  // shared: the list may change
    timeout->due.reset();
    timeout->handler();
  }

 private:
  void fire_traced(std::size_t number) {
    trace_.note(TraceEvent::What::Began, static_cast<std::int32_t>(number));
    fire(number);
    trace_.note(TraceEvent::What::Ended, static_cast<std::int32_t>(number));
    now_.read();
  }

  const Module& module_;
  std::vector<Timer>& timers_;
  std::vector<std::shared_ptr<Timeout::State>>& timeouts_;
  internal::Now& now_;
  internal::Trace& trace_;
};

}  // namespace hc
