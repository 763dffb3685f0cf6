// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module: a program with input ports, output ports and parameters, declared once.
//
//     int main(int argc, char** argv) {
//       hc::Module module{"brightness", "Measures how bright pictures are."};
//       auto image = module.input("image", hc::intensity_image<std::uint8_t>(), "a picture");
//       auto mean = module.output("mean", hc::table<double>(), "mean intensity, 0 … 255");
//       module.on(image, [&](const auto& picture) { mean.send(hc::table({average(picture)})); });
//       return module.run(argc, argv);
//     }
//
// Handlers run one after the other on the thread that called run().

#include <functional>
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
#include <hc/module/attention.h>
#include <hc/module/period.h>
#include <hc/module/port.h>

namespace hc {

/// Thrown by a handler, or by what a module calls, to end the module with one line and status 1;
/// with an error of Code::Invalid with status 2, which would be the same again.
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

class Module {
 public:
  /// @param name  as in the graph and on the command line: snake_case.
  /// @param summary  one sentence.
  Module(std::string name, std::string summary);
  /// The same by another clock than the machine's, which outlives the module: a test's. Who turns
  /// it wakes the module by a message, since waiting is by the machine's clock.
  Module(std::string name, std::string summary, const Clock& clock);
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;
  ~Module();

  /// Declares an input. The first one is standard input unless the command line links any.
  template <typename K>
  Input<K> input(const std::string& name, const K& kind, const std::string& doc) {
    if constexpr (std::is_same_v<K, AnyKind>)
      return {add_input(name, kind.types, doc)};
    else
      return {add_input(name, {kind.type}, doc)};
  }

  /// Declares an output. All outputs go to standard output unless the command line links any; their
  /// addresses (src), 1, 2, … in the order of declaration, tell them apart.
  template <typename K>
  Output<K> output(const std::string& name, const K& kind, const std::string& doc) {
    if constexpr (std::is_same_v<K, AnyKind>)
      return Output<K>(add_output(name, kind.types, doc));
    else
      return Output<K>(add_output(name, {kind.type}, doc));
  }

  /// Says that an input moves something: a graph in which several write to it needs somebody who
  /// decides (`exclusive`, a router).
  template <typename K>
  void actor(const Input<K>& input) {
    input.state->is_actor = true;
  }
  /// Says that each of the module's links gets what its address leads to (`--route`), and not all.
  void route_outputs() { routes_ = true; }

  /// Declares a parameter.
  /// @param otherwise  its default: a bool, an integer, a number or a string, which is its type
  /// too.
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

  /// Says what is done with each message of an input. Compressed elements have been expanded.
  template <typename K, typename Handler>
  void on(const Input<K>& input, Handler handler) {
    input.state->handler = [handler = std::move(handler)](const Message& message) {
      handler(MessageOf<K>{message});
    };
  }

  /// The same with each message as it came, of the kind it is: compressed elements are not
  /// expanded.
  template <typename Handler>
  void on_raw(const Input<AnyKind>& input, Handler handler) {
    input.state->handler = std::move(handler);
    input.state->is_raw = true;
  }

  /// Says what is done with messages that belong together, one of each input, by their times: equal
  /// ones, or those nearest to one another within a bound (Matcher has the rules).
  ///
  ///     module.on(hc::together(left, right), [&](const auto& l, const auto& r) { … });
  ///     module.on(hc::together(left, right, gaze).within(std::chrono::milliseconds(10)),
  ///               [&](const auto& l, const auto& r, const auto& g) { … });
  ///
  /// What the handler sends has the latest of their times (R43). The log says when the first
  /// message of an input is left out because its partners did not come, and at the end how many
  /// were. When an input has ended and its last message is settled, the others are read no more.
  /// An input that has a handler already is a bug.
  template <typename... Kinds, typename Handler>
  void on(const Together<Kinds...>& inputs, Handler handler) {
    static_assert(std::is_invocable_v<Handler&, const MessageOf<Kinds>&...>,
                  "the handler takes one message of each input");
    add_together(inputs.inputs, inputs.how,
                 [handler = std::move(handler)](std::span<const Message> set) mutable {
                   auto message = set.begin();
                   // In braces, arguments are evaluated from left to right.
                   const std::tuple messages{MessageOf<Kinds>{*message++}...};
                   std::apply(handler, messages);
                 });
  }

  /// Called once, when parameters are set and links are open.
  void on_start(std::function<void()> handler) { start_ = std::move(handler); }
  /// Called once, when all inputs have ended, before the outputs do. Not after an error.
  void on_end(std::function<void()> handler) { end_ = std::move(handler); }
  /// For a module that makes messages by itself: called again and again while no message waits,
  /// until it gives false. The module ends then.
  void generate(std::function<bool()> handler) { generate_ = std::move(handler); }

  /// Says what is done again and again, between messages: first a period after the start, and not
  /// made up for where it was missed. Does not keep a module running whose inputs have ended.
  /// @param rate  as it is now; 0 or less: never. [Hz]
  void every(const Parameter<double>& rate, std::function<void()> handler) {
    add_timer([rate] { return internal::period_of(*rate); }, std::move(handler));
  }
  void every(std::chrono::nanoseconds period, std::function<void()> handler) {
    add_timer([period] { return std::min(period, internal::kLongestPeriod); }, std::move(handler));
  }

  /// Says what is done when a descriptor of the module's own can be read, such as a device's,
  /// between messages. Does not keep a module running whose inputs have ended; a generator is not
  /// woken by it.
  /// @param descriptor  asked each time before the module waits; below 0: none now.
  /// @param handler  takes what is there without waiting; called when nothing is, too.
  void on_readable(std::function<int()> descriptor, std::function<void()> handler) {
    watches_.push_back({std::move(descriptor), std::move(handler)});
  }

  /// For generators: waits until the next period of a rate begins, counted from the first call.
  /// Slower while the module is idle, since another mode has the focus. A module that is told to
  /// stop ends here. @param rate [Hz]
  void keep_rate(double rate);

  /// Says something to the person who runs the module: one line on standard error, with the
  /// module's name before it.
  void log(std::string_view line) const;

  /// Wall clock, for messages that begin here: the machine's, or with `--clock messages` that of
  /// the messages which come. [ns since the Unix epoch]
  [[nodiscard]] std::int64_t now() const { return message_time_ ? *message_time_ : clock_.wall(); }
  /// The same clock for periods and time-outs, which never goes back. What is done in the time of
  /// messages goes by this; what talks to a device at the machine's pace has a clock of its own.
  [[nodiscard]] MonotonicTime monotonic() const {
    return message_time_ ? MonotonicTime(*message_time_) : clock_.monotonic();
  }

  /// Number of the system mode in focus, as last heard; 0: none, or nobody tells it.
  [[nodiscard]] std::int32_t focus() const { return attention_.focus; }

  /// Whether the module's mode has the focus, so that exclusive inputs take what it sends. Also
  /// when it has no mode of its own (`--mode`), and when nobody tells the focus.
  [[nodiscard]] bool has_focus() const { return attention_.is_heard(); }

  /// Runs the module as the command line says, until its inputs end, all its readers have gone, or
  /// it is told to stop (SIGINT, SIGTERM).
  /// @returns  what main() is to return: 0 done, 1 failure, 2 bad arguments.
  int run(int argc, char** argv);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& summary() const { return summary_; }
  [[nodiscard]] const auto& inputs() const { return inputs_; }
  [[nodiscard]] const auto& outputs() const { return outputs_; }
  [[nodiscard]] const auto& parameters() const { return parameters_; }
  [[nodiscard]] const auto& together() const { return together_; }
  [[nodiscard]] bool routes() const { return routes_; }

 private:
  friend void internal::send(internal::OutputState&, Message);
  friend std::size_t internal::forward(internal::OutputState&, const Message&);
  struct Loop;
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
                                                  std::string doc);
  std::shared_ptr<internal::OutputState> add_output(std::string name, std::vector<PortType> types,
                                                    std::string doc);
  void add_timer(Period period, std::function<void()> handler) {
    timers_.push_back({std::move(period), std::move(handler)});
  }
  std::shared_ptr<ParameterState> add_parameter(std::string name,
                                                const ParameterValue& default_value,
                                                std::string unit, std::string doc,
                                                ParameterOptions options);
  void add_together(const std::vector<std::shared_ptr<internal::InputState>>& inputs,
                    const Matching& how, Matcher::Take handler);
  /// Tells the log once for each input of which messages are left out.
  void tell_left_out(const internal::TogetherState& together) const;

  std::string name_, summary_;
  std::string instance_;  // its name in the graph
  std::vector<std::shared_ptr<internal::InputState>> inputs_;
  std::vector<std::shared_ptr<internal::OutputState>> outputs_;
  std::vector<std::shared_ptr<ParameterState>> parameters_;
  std::vector<std::unique_ptr<internal::TogetherState>> together_;
  std::function<void()> start_, end_;
  std::function<bool()> generate_;
  std::vector<Timer> timers_;
  std::vector<Watch> watches_;
  bool routes_ = false;
  const Clock& clock_;
  internal::Attention attention_;
  Loop* loop_ = nullptr;                      // while it runs
  std::optional<std::int64_t> message_time_;  // with --clock messages [ns]
  std::int64_t handled_time_ = 0;             // of the message being handled; 0: none
  std::int32_t handled_mode_ = 0;
  const std::string* handled_peer_ = nullptr;  // who sent it; null: nobody knows
  std::optional<MonotonicTime> last_period_;   // of keep_rate()
};

}  // namespace hc
