// SPDX-License-Identifier: Apache-2.0
#include <hc/module/schedule.h>

#include <algorithm>
#include <deque>
#include <utility>

#include <hc/module/loop.h>
#include <hc/os/program.h>

namespace hc {
namespace {

using internal::Inlet;

/// A longer time without messages is skipped, as missed periods are: one wrong time would otherwise
/// have timers fire for years.
constexpr MonotonicTime kLongestGap = std::chrono::hours(1);

}  // namespace

/// By the machine's clock: messages as they arrive, timers when they are due.
class Module::Schedule::Live final : public Schedule {
 public:
  explicit Live(Loop& loop) : loop_(loop) {}

  void begin() override { attend(); }

  bool turn() override {
    if (!std::exchange(was_wait_short_, false)) loop_.now.read();
    loop_.inlets.receive_focus();
    const bool any = loop_.inlets.take_each();
    loop_.work_between_messages();
    if (loop_.module.is_done_) return false;
    if (any) return true;
    if (loop_.module.generate_) {
      loop_.generate();
      return true;
    }
    if (!loop_.module.options_.keep_running && loop_.inlets.all_ended()) return false;
    was_wait_short_ = loop_.wait(true, loop_.timers.next());
    return true;
  }

  void pause(const std::function<MonotonicTime()>& due) override {
    for (loop_.now.read(); loop_.now.machine < due(); loop_.now.read()) {
      loop_.wait(false, due());
      attend();
    }
  }

 private:
  /// The work during a pause, which takes no messages.
  void attend() {
    loop_.now.read();
    loop_.inlets.receive_focus();
    loop_.serve();
  }

  Loop& loop_;
  bool was_wait_short_ = false;  // the clock need not be read again
};

/// By the messages' clock: messages in the order of their times, and timers between them. The
/// result depends on the messages, and not on when they arrive.
class Module::Schedule::ByMessages : public Schedule {
 public:
  explicit ByMessages(Loop& loop) : loop_(loop) {}

  /// The clock begins with the first message that has a time.
  void begin() override {
    while (true) {
      loop_.now.read();
      loop_.serve();
      if (take_heads()) break;
      if (stop_requested()) throw internal::Stopped();
      loop_.wait(true, MonotonicTime::max());
    }
    auto first = MonotonicTime::max();
    loop_.inlets.for_each([&](const Inlet& inlet) {
      if (inlet.head && inlet.time() != MonotonicTime(0)) first = std::min(first, inlet.time());
    });
    if (first != MonotonicTime::max()) loop_.now.pass_to(first);
  }

  bool turn() override {
    loop_.now.read();
    loop_.delivery.expire_focus();
    const Next next = advance();
    loop_.work_between_messages();
    if (loop_.module.is_done_) return false;
    if (next == Next::Advance) return true;
    if (next == Next::Generate) {
      has_generated_ = true;
      loop_.generate();
      return true;
    }
    if (loop_.inlets.all_ended()) return false;
    loop_.wait(true, MonotonicTime::max());
    return true;
  }

  /// Time passes at once.
  void pause(const std::function<MonotonicTime()>& due) override {
    has_generated_ = false;
    loop_.now.pass_to(std::max(loop_.now.time(), due()));
  }

 protected:
  /// Takes the next message of each link, its head; false if one has to be waited for.
  bool take_heads() {
    bool all = true;
    Message message;
    loop_.inlets.for_each([&](Inlet& inlet) {
      if (!inlet.is_open()) return;
      const auto got = loop_.inlets.take(inlet, message);
      if (got == Got::Message) inlet.head = message.keep();
      if (got == Got::Nothing) all = false;
    });
    return all;
  }

  void handle_head(Inlet& inlet) {
    Message message = *std::exchange(inlet.head, std::nullopt);
    loop_.delivery.handle(inlet, message);
  }

  Loop& loop_;

 private:
  enum class Next { Advance, Generate, Wait };

  /// The inlet whose head is the earliest; of equal times the focus, then the first. Null: none.
  Inlet* earliest() {
    Inlet* first = nullptr;
    loop_.inlets.for_each([&](Inlet& inlet) {
      if (inlet.head && (first == nullptr || inlet.time() < first->time())) first = &inlet;
    });
    return first;
  }

  /// Handles the earliest message, or lets time pass until a timer that is due before.
  Next advance() {
    if (!take_heads()) return Next::Wait;
    const bool generates = loop_.module.generate_ != nullptr;
    if (loop_.inlets.all_ended())
      return generates && !std::exchange(has_ended_, true) ? Next::Generate : Next::Wait;
    Inlet* inlet = earliest();
    if (inlet == nullptr) return Next::Wait;  // none is linked yet
    const auto now = loop_.now.time();
    const auto due = std::max(inlet->time(), now);  // a message without a time is due now
    const auto timer = loop_.timers.next();
    if (due - now > kLongestGap) {
      loop_.now.pass_to(due);
    } else if (timer > now && timer <= due) {
      loop_.now.pass_to(timer);
    } else if (generates && due > now && !has_generated_) {
      return Next::Generate;
    } else {
      loop_.now.pass_to(due);
      loop_.delivery.expire_focus();
      has_generated_ = false;
      handle_head(*inlet);
      loop_.inlets.sets().handle_newest();
    }
    return Next::Advance;
  }

  bool has_generated_ = false;  // since the last message, without keeping a rate
  bool has_ended_ = false;      // all messages have been handled
};

/// The work of an earlier run again, at the same moments, by its trace.
class Module::Schedule::Replay final : public ByMessages {
 public:
  Replay(Loop& loop, const Uri& trace) : ByMessages(loop) {
    const auto source = loop.opener.open(trace, "clock");
    Message message;
    while (true) {
      const auto any = receive(*source, message);
      if (!any) internal::fail(trace.text(), any.error());
      if (!*any) return;
      for (auto& event : read_trace(message)) {
        if (!first_) first_ = event.moment.time_since_epoch();
        if (is_repeated(event)) events_.push_back(std::move(event));
      }
    }
  }

  /// The clock begins with the trace.
  void begin() override {
    loop_.now.read();
    loop_.serve();
    if (first_) loop_.now.pass_to(*first_);
  }

  bool turn() override {
    if (events_.empty()) return false;
    loop_.now.read();
    repeat_next();
    loop_.serve();
    return true;
  }

  /// The focus is received during a pause, as it was.
  void pause(const std::function<MonotonicTime()>& due) override {
    while (!events_.empty() && events_.front().port == internal::kFocusPort) repeat_next();
    ByMessages::pause(due);
  }

  void read_clock() override {
    if (events_.empty() || events_.front().what != What::Read) return;
    pass_to_next();
    events_.pop_front();
  }

 private:
  using What = TraceEvent::What;

  static bool is_repeated(const TraceEvent& event) {
    return event.what == What::Began || event.what == What::Set || event.what == What::Read;
  }

  void pass_to_next() {
    loop_.now.pass_to(std::max(loop_.now.time(), events_.front().moment.time_since_epoch()));
  }

  /// Repeats an event at its moment, or waits for messages. Events without a cause in this module,
  /// which may have changed since, are skipped.
  void repeat_next() {
    if (!take_heads()) {
      loop_.wait(true, MonotonicTime::max());
      return;
    }
    pass_to_next();
    const TraceEvent event = std::move(events_.front());
    events_.pop_front();
    if (event.what == What::Read) return;
    // A parameter that the module does not have any more has no effect.
    if (event.what == What::Set)
      return static_cast<void>(loop_.remote.set_parameter(event.port, event.value));
    loop_.delivery.expire_focus();
    if (!event.port.empty())
      handle_head_of(event);
    else if (event.number != TraceEvent::kGenerator)
      loop_.timers.fire(static_cast<std::size_t>(event.number));
    else if (loop_.module.generate_)
      loop_.module.generate_();
  }

  void handle_head_of(const TraceEvent& event) {
    Inlet* found = nullptr;
    loop_.inlets.for_each([&](Inlet& inlet) {
      if (found == nullptr && inlet.head && inlet.number == event.number &&
          inlet.port() == event.port)
        found = &inlet;
    });
    if (found != nullptr) handle_head(*found);
  }

  std::optional<MonotonicTime> first_;
  std::deque<TraceEvent> events_;
};

std::unique_ptr<Module::Schedule> Module::Schedule::make(Loop& loop,
                                                         const std::optional<Uri>& trace) {
  if (trace) return std::make_unique<Replay>(loop, *trace);
  if (loop.module.message_time_) return std::make_unique<ByMessages>(loop);
  return std::make_unique<Live>(loop);
}

}  // namespace hc
