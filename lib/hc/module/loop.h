// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module at work: its links, its timers and its schedule. Internal.

#include <functional>
#include <memory>
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
  /// Opens the links: those of outputs first, so that listeners are there before anything waits.
  Loop(Module& module, const internal::Arguments& arguments, int stop);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Runs until all inputs have ended, or Module::stop().
  void run();
  /// Handles the messages of modules that end at the same time (Module::finish_when_stopped()).
  void take_rest();
  /// See Schedule::pause().
  void pause(const std::function<MonotonicTime()>& due) { schedule_->pause(due); }
  /// Closes the outlets.
  void close();
  [[nodiscard]] bool has_failed_input() const { return delivery.has_failed_input(); }
  void report_state() { remote.report_state(); }
  void note(TraceEvent::What what, const std::string& port, const Header& header) {
    trace.note(what, port, header);
  }

  // For its schedule.

  /// Obeys commands and reports, every 10 ms while the module is busy.
  void serve();
  /// Ends and joins links, serves, fires timers, and reads the module's own descriptors.
  void work_between_messages();
  void generate();
  /// Waits for a time, a command, a report that is due; with `for_messages` also for messages of
  /// inputs and for the module's own descriptors. Returns whether the wait was so short that the
  /// clock need not be read again.
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
  void read_watched();
  void end();

  std::unique_ptr<Schedule> schedule_;
  WaitSet waits_, pauses_;  // for messages; between two calls of a generator
  std::vector<Source*> waited_for_;
  std::vector<int> watched_;
  MonotonicTime served_{0};
};

}  // namespace hc
