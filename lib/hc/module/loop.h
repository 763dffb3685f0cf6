// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module at work: takes messages from its links and hands them to the handlers, obeys commands,
// and reports. Internal.

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include <hc/link/wait_set.h>
#include <hc/module/arguments.h>
#include <hc/module/ending.h>
#include <hc/module/inlets.h>
#include <hc/module/link_opener.h>
#include <hc/module/module.h>
#include <hc/module/outlets.h>
#include <hc/module/remote.h>
#include <hc/module/timers.h>
#include <hc/module/trace.h>

namespace hc {

struct Module::Loop {
  /// Opens the links: outputs first, since those that listen must be there before anybody waits.
  Loop(Module& module, const internal::Arguments& arguments, int stop);
  ~Loop();
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  /// Until all inputs have ended, and the generator has.
  void run();
  /// Takes what comes of modules that end beside it (Module::finish_when_stopped()).
  void take_rest();
  /// Waits until a time that `due` gives, which may change with the focus; obeys meanwhile.
  void pause(const std::function<MonotonicTime()>& due);
  /// Ends the outputs.
  void close();
  /// Whether a file or standard input had messages that were dropped since they were bad, so that
  /// the module has not done its work.
  [[nodiscard]] bool has_failed_input() const { return delivery_.has_failed_input(); }
  void report_state() { remote_.report_state(); }
  /// Notes a moment in the way of a message, while the module is traced.
  void note(TraceEvent::What what, const std::string& port, const Header& header) {
    trace_.note(what, port, header);
  }

 private:
  void read_watched();
  bool wait(bool for_messages, MonotonicTime until);

  // loop_messages.cpp
  [[nodiscard]] bool is_generators_turn() const;
  bool generate();
  void begin_clock();
  bool take_earliest();
  bool has_heads();
  [[nodiscard]] internal::Inlet* earliest();
  void read_moments(const Uri& uri);
  bool repeat_next();
  void repeat_without_message(std::int32_t number);

  void attend();
  void serve();

  Module& module_;
  internal::Now now_;
  internal::Trace trace_;
  Timers timers_;
  LinkOpener opener_;
  Delivery delivery_;
  Inlets inlets_;
  Outlets outlets_;
  Remote remote_;
  WaitSet waits_, pauses_;  // for all there is; between two calls of the generator
  std::vector<Source*> waited_for_;
  std::vector<int> watched_;
  std::optional<std::deque<TraceEvent>> moments_;  // with --clock URI: to be repeated
  MonotonicTime attended_{0};
  // With --clock messages: whether the generator is called next; has been since the last message,
  // and keeps no rate; and whether all messages have been handled.
  bool generates_next_ = false, has_generated_ = false, has_ended_ = false;
};

}  // namespace hc
