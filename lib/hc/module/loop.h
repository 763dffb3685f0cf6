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
#include <hc/module/link_opener.h>
#include <hc/module/management.h>
#include <hc/module/module.h>
#include <hc/module/outlets.h>
#include <hc/module/quantiles.h>
#include <hc/module/timers.h>
#include <hc/module/trace.h>

namespace hc {

namespace internal {

/// The port of inlets that receive the focus.
inline const std::string kFocusPort = "focus";

/// A link whose messages come in: to one port, to all of them from standard input, or the focus.
struct Inlet {
  std::string uri;
  std::unique_ptr<Source> source = {};   ///< null once it has ended
  std::vector<InputState*> inputs = {};  ///< none: the focus
  std::optional<Message> head =
      {};                          ///< with --clock messages: taken, and to be handled in its time
  Route route = {};                ///< who is at the other end
  std::int32_t number = 0;         ///< of the links of its port
  bool is_latest = false;          ///< keep=latest, of an input that is taken together with others
  Traffic past = {};               ///< of sources that have ended
  std::uint64_t ignored = 0;       ///< messages that no handler got: another mode has the focus
  std::uint64_t bad = 0;           ///< messages that were dropped; see BadMessage
  Quantiles ages = {}, gaps = {};  ///< of the messages since the last report; gaps between them
  MonotonicTime last_come{0};      ///< the message before; 0: none

  [[nodiscard]] Traffic traffic() const {
    Traffic all = past;
    if (source != nullptr) all += source->traffic();
    all.bad += bad;
    return all;
  }
  /// Whether it cannot go on, once all has been read: a file, or standard input.
  [[nodiscard]] bool is_file() const { return uri == "-" || uri.starts_with("file:"); }
  [[nodiscard]] bool is_same(const Inlet& other) const {
    return uri == other.uri && inputs == other.inputs;
  }
};

}  // namespace internal

struct Module::Loop {
  static constexpr std::chrono::milliseconds kReportPeriod{500};

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
  [[nodiscard]] bool has_failed_input() const { return has_failed_input_; }
  /// @param blocked  the link whose reader the module waits for; null: none.
  void report_state(const internal::Outlet* blocked = nullptr);
  /// Notes a moment in the way of a message, while the module is traced.
  void note(TraceEvent::What what, const std::string& port, const Header& header) {
    trace_.note(what, port, header);
  }

 private:
  void open_input(const Uri& uri, std::vector<internal::InputState*> inputs);
  void open_inputs(const internal::Arguments& arguments);
  void open_focus(const Uri& uri);
  bool join_renewed();
  void choose_policies();
  void set_route(const std::string& link, const internal::Route& route);

  bool take_each();
  void handle_newest();
  bool take_one(internal::Inlet& inlet);
  Got take(internal::Inlet& inlet, Message& message);
  [[nodiscard]] bool is_linked(const internal::InputState& input) const;
  [[nodiscard]] bool all_ended() const;
  void end(internal::Inlet& inlet);
  void end_unlinked();
  void end_unneeded();
  void log_dropped();
  void measure(internal::Inlet& inlet, std::int64_t sensed, MonotonicTime come);
  void handle(internal::Inlet& inlet, Message& message);
  void deliver(internal::Inlet& inlet, Message& message);
  static Error misfit_of(const internal::Inlet& inlet, const Message& message);
  void drop(internal::Inlet& inlet, const std::string& who, std::string_view why);
  /// Handles a message, or a set of them, which may be bad: that is what any exception says that is
  /// no ModuleError, such as those of libraries that do not take every image.
  template <typename Handle>
  void drop_bad(internal::Inlet& inlet, const std::string& who, const Handle& handle) {
    try {
      handle();
    } catch (const ModuleError&) {
      throw;
    } catch (const std::exception& why) {
      module_.handled_ = {};
      drop(inlet, who, internal::thrown_in_words(why));
    }
  }
  void call(const internal::InputState& input, internal::Inlet& inlet, Message& message);
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

  // loop_control.cpp
  void attend();
  void serve();
  void look_at_silent();
  void receive_focus();
  void set_focus(internal::Inlet& inlet, const Message& message);
  void expire_focus();
  void obey(const std::string& command);
  bool obey_while_sending();
  Status carry_out(const std::string& row);
  Status set_parameter(const std::string& name, const std::string& value);
  Status link(bool is_input, const std::string& text);
  Status unlink(bool is_input, const std::string& text);
  Status finish(const std::string& text);
  void send(Report report, Message message);
  void report();
  void report_counters();
  void report_links();
  void report_parameters();

  Module& module_;
  internal::Now now_;
  internal::Trace trace_;
  Timers timers_;
  LinkOpener opener_;
  std::vector<internal::Inlet> inlets_;
  std::vector<internal::Inlet> focus_;
  internal::Management& management_;
  Outlets outlets_;
  WaitSet waits_, pauses_;  // for all there is; between two calls of the generator
  std::vector<Source*> waited_for_;
  std::vector<int> watched_;
  std::vector<std::string> deferred_;  // commands for when nothing is being handled or sent
  std::optional<std::deque<TraceEvent>> moments_;  // with --clock URI: to be repeated
  MonotonicTime reported_{0}, attended_{0};
  // With --clock messages: whether the generator is called next; has been since the last message,
  // and keeps no rate; and whether all messages have been handled.
  bool has_failed_input_ = false;
  bool generates_next_ = false, has_generated_ = false, has_ended_ = false;
};

}  // namespace hc
