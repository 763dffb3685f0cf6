// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module at work: its links, its timers and its schedule. Internal.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hc/link/wait_set.h>
#include <hc/module/arguments.h>
#include <hc/module/ending.h>
#include <hc/module/inlets.h>
#include <hc/module/link_opener.h>
#include <hc/module/outlets.h>
#include <hc/module/remote.h>
#include <hc/module/schedule.h>
#include <hc/module/timers.h>

namespace hc {

struct Module::Loop {
  /// Opens the links: those of outputs first, so that all modules listen before any of them waits.
  Loop(Module& module, const internal::Arguments& arguments, int stop);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  void begin();
  /// Works until all inputs have ended, or Module::stop().
  void work();
  /// The next message of a pulled input, which is then being handled; none at its end.
  std::optional<Message> next(internal::InputState& input);
  /// See ModuleOptions::finish_when_stopped.
  void take_rest();
  /// All inputs have ended.
  void finish();
  /// Calls on_end(), unless on_start() has not been called.
  void end();
  /// See Schedule::pause().
  void pause(const std::function<MonotonicTime()>& due) { schedule_->pause(due); }
  void close();
  [[nodiscard]] bool has_failed_input() const { return delivery.has_failed_input(); }
  void report_state() { remote.report_state(); }
  void note(TraceEvent::What what, const std::string& port, const Header& header) {
    trace.note(what, port, header);
  }
  /// The module's clock, for the module.
  Time read_clock() {
    if (!now.message_time) return trace.read_clock();
    schedule_->read_clock();
    return *now.message_time;
  }

  // For its schedule.

  /// Obeys commands and sends reports, every 10 ms while the module is busy.
  void serve();
  /// Everything except messages: ends links, serves, fires timers, reads own descriptors.
  void work_between_messages();
  void generate();
  /// Waits until a time, for commands and the focus; with `for_messages` also for messages and own
  /// descriptors. Returns whether it was so short that the clock need not be read again.
  bool wait(bool for_messages, MonotonicTime until);

  Module& module;
  internal::Now now;
  internal::Trace trace;
  Timers timers;
  LinkOpener opener;
  Delivery delivery;
  Inlets inlets;
  Outlets outlets;
  Remote remote;

 private:
  bool turn();
  [[nodiscard]] bool has_asked_ended() const {
    return asked_ != nullptr && inlets.have_ended(*asked_);
  }
  void end_pulled();
  void read_watched();

  std::unique_ptr<Schedule> schedule_;
  WaitSet waits_, pauses_;  // for messages; between two calls of a generator
  std::vector<Source*> waited_for_;
  std::vector<int> watched_;
  MonotonicTime served_{0}, looked_{0};          // when commands were, and own descriptors
  bool has_begun_ = false;                       // on_start() has been called
  bool has_waited_ = false;                      // for messages, in this turn
  const internal::InputState* asked_ = nullptr;  // for its next message
  std::function<void()> note_end_;  // of the message that was pulled last; its handling ends then
};

}  // namespace hc
