// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module: a program with input ports, output ports and parameters, declared once.
//
//     int main(int argc, char** argv) {
//       hc::Module module{"brightness", "Measures how bright images are."};
//       auto image = module.input("image", hc::image(), "any image");
//       auto mean = module.output("mean", hc::table(), "mean intensity, 0 … 255");
//       module.on(image, [&](const hc::Image& image) { mean.send(average(image.pixels())); });
//       return module.run(argc, argv);
//     }
//
// Handlers run one after the other on the thread that called run().

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <hc/base/parameter.h>
#include <hc/contract/log_line.h>
#include <hc/module/focus.h>
#include <hc/module/period.h>
#include <hc/module/port.h>

namespace hc {

/// Thrown by a handler, or by what it calls, to end the module with one line and status 1; an error
/// of Code::Invalid ends it with status 2, since a restart would fail again.
struct ModuleError : std::runtime_error {
  using std::runtime_error::runtime_error;
  explicit ModuleError(const Error& error)
      : std::runtime_error(error.text()), is_usage(error.code == Code::Invalid) {}

  bool is_usage = false;
};

/// The value of a result; a failed one ends the module.
template <typename T>
T value_or_end(Result<T> result) {
  if (!result) throw ModuleError(result.error());
  return std::move(*result);
}

/// A failed status ends the module.
inline void succeed_or_end(const Status& status) {
  if (!status) throw ModuleError(status.error());
}

/// Ends the module with status 2, since a restart would find the same: its arguments, or the files
/// that they name, cannot be used.
[[noreturn]] inline void refuse(const std::string& why) {
  throw ModuleError(Error{Code::Invalid, why});
}
/// The same because of a parameter. @param why  may begin with the parameter's name.
template <typename P>
[[noreturn]] void refuse(const Parameter<P>& parameter, const std::string& why) {
  const auto name = parameter.name() + ": ";
  refuse(why.starts_with(name) ? why : "parameter " + name + why);
}

/// The value of a result that depends only on a parameter, such as the contents of the file that it
/// names; a failed one ends the module with status 2. A device that may be plugged in later is no
/// such value: wait for it.
template <typename T, typename P>
T value_or_refuse(const Parameter<P>& parameter, Result<T> result) {
  if (!result) refuse(parameter, result.error().detail);
  return std::move(*result);
}

/// Thrown by a handler, or by what it calls, since the message that it got says what it cannot use:
/// that message is dropped, counted (`bad`) and logged, once for each input, and the module goes
/// on.
struct BadMessage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The value of a result; a failed one drops the message that is being handled.
template <typename T>
T value_or_drop(Result<T> result) {
  if (!result) throw BadMessage(result.error().detail);
  return std::move(*result);
}

/// A failed status drops the message that is being handled.
inline void succeed_or_drop(const Status& status) {
  if (!status) throw BadMessage(status.error().detail);
}

namespace internal {
struct Arguments;
class Management;
}  // namespace internal
class Module;

/// A timer that fires once each time it is started: Module::after(). Copies are the same timer.
class Timeout {
 public:
  /// Restarts the timer with its duration, or another one.
  void restart();
  void restart(std::chrono::nanoseconds duration);
  void stop() { state_->due.reset(); }

 private:
  friend class Module;
  struct State {
    Module& module;
    std::chrono::nanoseconds duration;
    std::function<void()> handler;
    std::optional<MonotonicTime> due;
  };
  explicit Timeout(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

/// How a module runs.
struct ModuleOptions {
  /// The process yields the processor to closed loops: nice 10, batch scheduling. For a module that
  /// takes a core and is in no hurry.
  bool background = false;
  /// The module runs until it is stopped, or its last reader has disconnected, though its inputs
  /// have ended: for a device that sends unasked. Not with `--clock messages`.
  bool keep_running = false;
  /// A module that is asked to stop first takes the messages that still come from modules that end
  /// beside it, until there are none for 0.2 s, at most 2 s; then on_end() is called.
  bool finish_when_stopped = false;
  /// Outputs route by address: a link gets only the messages of its `--route`.
  bool routes = false;
  /// Another clock than the machine's, for tests; it outlives the module. Advancing it does not
  /// wake the module: send a message.
  const Clock* clock = nullptr;
};

class Module {
 public:
  /// @param name  as in the graph and on the command line: snake_case.
  /// @param summary  one sentence.
  Module(std::string name, std::string summary, const ModuleOptions& options = {});
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;
  ~Module();

  /// Declares an input. The first one is standard input unless the command line links any.
  template <typename K>
  Input<K> input(const std::string& name, const K& kind, const std::string& doc,
                 const InputOptions& options = {}) {
    if constexpr (std::is_base_of_v<AnyKind, K>)
      return Input<K>(add_input(name, kind.types, doc, options));
    else
      return Input<K>(add_input(name, {kind.type}, doc, options));
  }

  /// Declares an output. All outputs go to standard output unless the command line links any; their
  /// addresses (src), 1, 2, … in the order of declaration, tell them apart.
  template <typename K>
  Output<K> output(const std::string& name, const K& kind, const std::string& doc,
                   const OutputOptions& options = {}) {
    if constexpr (std::is_same_v<K, AnyKind>)
      return Output<K>(add_output(name, kind.types, doc, options));
    else
      return Output<K>(add_output(name, {kind.type}, doc, options));
  }

  /// Declares a parameter.
  /// @param default_value  a bool, an integer, a number or a string, which is its type too.
  /// @param unit  "m", "rad", "px", "s"; "" for none.
  template <typename T>
  auto parameter(std::string name, const T& default_value, std::string unit, std::string doc,
                 ParameterOptions options = {}) {
    using Value = std::conditional_t<
        std::is_same_v<T, bool>, bool,
        std::conditional_t<std::is_integral_v<T>, std::int64_t,
                           std::conditional_t<std::is_floating_point_v<T>, double, std::string>>>;
    return Parameter<Value>(add_parameter(std::move(name), ParameterValue(Value(default_value)),
                                          std::move(unit), std::move(doc), std::move(options)));
  }

  /// Calls a handler with each message of an input. Compressed elements have been expanded.
  template <typename K, typename Handler>
  void on(const Input<K>& input, Handler handler) {
    input.state_->handler = [handler = std::move(handler)](Message& message) {
      handler(MessageOf<K>{std::move(message)});
    };
  }

  /// The same with each message as it came, of the kind it is: compressed elements are not
  /// expanded.
  template <typename Handler>
  void on_raw(const Input<AnyKind>& input, Handler handler) {
    input.state_->handler = std::move(handler);
    input.state_->is_raw = true;
  }

  /// Calls a handler with messages that belong together, one of each input, by their equal times
  /// (Matcher has the rules).
  ///
  ///     module.on(hc::together(left, right), [&](const auto& l, const auto& r) { … });
  ///
  /// What the handler sends has the latest of their times (R43), and their coord where it is the
  /// same. Messages without a partner are dropped; the first of an input is logged, and at the end
  /// how many there were. When an input has ended and its last message is settled, the others are
  /// no longer read. An input with two handlers is a bug.
  template <typename... Kinds, typename Handler>
  void on(const Together<Kinds...>& inputs, Handler handler) {
    static_assert(std::is_invocable_v<Handler&, const MessageOf<Kinds>&...>,
                  "the handler takes one message of each input");
    add_together(inputs.inputs_,
                 [handler = std::move(handler)](std::span<const Message> set) mutable {
                   auto message = set.begin();
                   // In braces, arguments are evaluated from left to right.
                   const std::tuple messages{MessageOf<Kinds>{*message++}...};
                   std::apply(handler, messages);
                 });
  }

  /// Called once, when parameters are set and links are open.
  void on_start(std::function<void()> handler) { start_ = std::move(handler); }
  /// Called once, before the outputs end: when all inputs have ended, after stop(), when no reader
  /// is left, or when the module is asked to stop (stop_requested() says so; then it is to be
  /// quick). Not after an error.
  void on_end(std::function<void()> handler) { end_ = std::move(handler); }
  /// For a module that makes messages unasked: called again and again while no message waits, until
  /// stop().
  void generate(std::function<void()> handler) { generate_ = std::move(handler); }

  /// Calls a handler periodically, between messages: first a period after the start. Periods that
  /// were missed are skipped. Does not keep a module running whose inputs have ended.
  /// @param rate  looked at each time; 0 or less: never. [Hz]
  void every(const Parameter<double>& rate, std::function<void()> handler) {
    add_timer([rate] { return internal::period_of(*rate); }, std::move(handler));
  }
  void every(std::chrono::nanoseconds period, std::function<void()> handler) {
    add_timer([period] { return std::min(period, internal::kLongestPeriod); }, std::move(handler));
  }

  /// Calls a handler once, between messages, when `duration` has passed since the start or, while
  /// the module runs, since this call; again after Timeout::restart(), as a watchdog does:
  ///
  ///     auto silence = module.after(3s, [&] { module.log("no packets for 3 s"); });
  ///     module.on(packet, [&](const auto&) { silence.restart(); });
  ///
  /// Does not keep a module running whose inputs have ended.
  Timeout after(std::chrono::nanoseconds duration, std::function<void()> handler);

  /// Calls a handler when a descriptor of the module's own is readable, such as a device's, or has
  /// failed, between messages. Does not keep a module running whose inputs have ended; a generator
  /// is not woken by it.
  /// @param descriptor  asked each time before the module waits; below 0: none now.
  /// @param handler  reads without waiting; there may be nothing to read.
  void on_readable(std::function<int()> descriptor, std::function<void()> handler) {
    watches_.push_back({std::move(descriptor), std::move(handler)});
  }

  /// For generators: waits until the next period of a rate begins, counted from the first call.
  /// A module that is asked to stop ends here. @param rate [Hz]
  void keep_rate(double rate);
  /// The same until a time of monotonic().
  void wait_until(MonotonicTime time);

  /// Ends the module when the handler that calls this has returned: no other handler is called but
  /// on_end(), the outputs end, and run() gives 0.
  void stop() { is_done_ = true; }

  /// Writes a line to standard error, with the module's name before it.
  /// Of another level than Info it is reported where `hc run` runs the module.
  void log(std::string_view line, Level level = Level::Info) const;

  /// Logs the first problem of a kind and counts the others; the counts are logged at the end.
  ///
  ///     module.log_once("stale", "command dropped: 0.3 s old");
  ///
  /// @param kind  a literal, as the count names it: "total: 12 stale".
  /// @param count  how many there were.
  void log_once(const std::string& kind, std::string_view line, std::int64_t count = 1);

  /// Wall clock, for messages that begin here: the machine's, or with `--clock messages` that of
  /// the messages which come. Like all functions, only for the module's thread.
  [[nodiscard]] Time now() const;
  /// When the data of a message was measured; now(), if its header does not say it.
  [[nodiscard]] Time time_of(const Header& header) const {
    return header.time != Time() ? header.time : now();
  }
  /// The same clock for periods and time-outs, which never goes back. What is done in the time of
  /// messages goes by this; what talks to a device at the machine's pace has a clock of its own.
  [[nodiscard]] MonotonicTime monotonic() const;

  /// Number of the system mode in focus; 0: none, or the workspace has not repeated it for 120 ms.
  [[nodiscard]] std::int32_t focus() const { return focus_.current; }

  /// Whether the module's mode has the focus, so that exclusive inputs take what it sends. Also
  /// when it has no mode of its own (`--mode`), and when it has no link from a workspace.
  [[nodiscard]] bool has_focus() const { return focus_.has_own_focus(); }

  /// Runs the module as the command line says, until its inputs end, all its readers have
  /// disconnected, or it is asked to stop (SIGINT, SIGTERM, SIGHUP).
  /// @returns  what main() is to return: 0 done, 1 failure, 2 bad arguments.
  int run(int argc, char** argv);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Its name in the graph; its name where it runs alone.
  [[nodiscard]] const std::string& instance() const { return instance_; }

 private:
  friend struct ModuleAccess;
  friend void internal::send(internal::OutputState&, Message&&);
  friend std::size_t internal::forward(internal::OutputState&, const Message&);
  friend class Timeout;
  class Run;
  struct Loop;  // and its parts
  class Delivery;
  class Inlets;
  class LinkOpener;
  class Outlets;
  class Remote;
  class Schedule;
  class Sets;
  class Timers;
  using Period = std::function<MonotonicTime()>;
  struct Timer {
    Period period;
    std::function<void()> handler;
    MonotonicTime last{0};  // when it was due, or the start
    [[nodiscard]] MonotonicTime due() const { return last + period(); }
  };
  struct Watch {
    std::function<int()> descriptor;
    std::function<void()> handler;
  };

  /// Whether any output has a reader left.
  [[nodiscard]] bool is_read() const;

  std::shared_ptr<internal::InputState> add_input(std::string name, std::vector<PortType> types,
                                                  std::string doc, const InputOptions& options);
  std::shared_ptr<internal::OutputState> add_output(std::string name, std::vector<PortType> types,
                                                    std::string doc, const OutputOptions& options);
  void add_timer(Period period, std::function<void()> handler) {
    timers_.push_back({std::move(period), std::move(handler)});
  }
  std::shared_ptr<ParameterState> add_parameter(std::string name,
                                                const ParameterValue& default_value,
                                                std::string unit, std::string doc,
                                                ParameterOptions options);
  void add_together(const std::vector<std::shared_ptr<internal::InputState>>& inputs,
                    Matcher::Take handler);
  /// Handles the set that is complete, if there is one.
  void handle(internal::TogetherState& together);
  /// Logs the first unmatched message of each input, and when none match for long.
  void log_unmatched(internal::TogetherState& together);
  void log_counts() const;

  std::string name_, summary_;
  std::string instance_;  // its name in the graph
  std::vector<std::shared_ptr<internal::InputState>> inputs_;
  std::vector<std::shared_ptr<internal::OutputState>> outputs_;
  std::vector<std::shared_ptr<ParameterState>> parameters_;
  std::vector<std::unique_ptr<internal::TogetherState>> together_;
  std::function<void()> start_, end_, before_waiting_;
  std::function<void()> generate_;
  std::vector<Timer> timers_;
  std::vector<Watch> watches_;
  std::vector<std::shared_ptr<Timeout::State>> timeouts_;
  std::map<std::string, std::int64_t> logged_;  // problems of a kind
  bool is_done_ = false;                        // see stop()
  ModuleOptions options_;
  const Clock& clock_;
  internal::Focus focus_;
  Loop* loop_ = nullptr;                              // while it runs
  std::shared_ptr<internal::Management> management_;  // from then on
  std::optional<Time> message_time_;                  // with --clock messages
  internal::Handled handled_;                         // the message being handled
  std::optional<MonotonicTime> last_period_;          // of keep_rate()
};

/// For the runtime, the workspace and bindings to other languages.
struct ModuleAccess {
  static const auto& inputs(const Module& module) { return module.inputs_; }
  static const auto& outputs(const Module& module) { return module.outputs_; }
  static const auto& parameters(const Module& module) { return module.parameters_; }
  static const auto& together(const Module& module) { return module.together_; }
  static const std::string& summary(const Module& module) { return module.summary_; }
  static bool routes(const Module& module) { return module.options_.routes; }
  using Run = Module::Run;

  /// For the arbiter itself, which has no focus: reports which mode has it, and who holds it back,
  /// as `hc ps` shows it. Its next process gets `stops` back, in the parameter kStops.
  static void report_focus(Module& module, std::int32_t mode, const Stops& stops);

  /// Calls a function before the module waits or closes its links, and every 10 ms while messages
  /// come: to release a lock that is kept from one handler to the next.
  static void before_waiting(Module& module, std::function<void()> handler) {
    module.before_waiting_ = std::move(handler);
  }
};

}  // namespace hc
