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
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hc/base/parameter.h>
#include <hc/node/port.h>

namespace hc {

/// Thrown by a handler, or by what a module calls, to end the module with one line and status 1.
struct ModuleError : std::runtime_error {
  using std::runtime_error::runtime_error;
  explicit ModuleError(const Error& error) : std::runtime_error(error.text()) {}
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
    return Output<K>(add_output(name, kind.type, doc));
  }

  /// Declares a parameter.
  /// @param otherwise  its default: a bool, an integer, a number or a string, which is its type
  /// too.
  /// @param unit  "m", "rad", "px", "s"; "" for none.
  template <typename T>
  auto parameter(std::string name, const T& otherwise, std::string unit, std::string doc,
                 ParameterOptions options = {}) {
    using Value = std::conditional_t<
        std::is_same_v<T, bool>, bool,
        std::conditional_t<std::is_integral_v<T>, std::int64_t,
                           std::conditional_t<std::is_floating_point_v<T>, double, std::string>>>;
    return Parameter<Value>(add_parameter(std::move(name), ParameterValue(Value(otherwise)),
                                          std::move(unit), std::move(doc), std::move(options)));
  }

  /// Says what is done with each message of an input. Compressed elements have been expanded.
  template <typename K, typename Handler>
  void on(const Input<K>& input, Handler handler) {
    input.state->handler = [handler = std::move(handler)](const Message& message) {
      handler(MessageOf<K>{message});
    };
  }

  /// At most so many messages of an input, and bytes of elements, wait for their partners.
  static constexpr std::size_t kMostWaiting = 64;
  static constexpr std::uint64_t kMostWaitingBytes = std::uint64_t{256} << 20;

  /// Takes the messages of two inputs together, those of the same time; what the handler sends has
  /// the later of their times. One that has no partner is left out, which the log says once, when a
  /// later one comes to the other input or more than kMostWaiting wait. Messages without a time are
  /// taken in the order in which they come.
  template <typename A, typename B, typename Handler>
  void on_both(const Input<A>& first, const Input<B>& second, Handler handler) {
    add_pair(first.state, second.state,
             [handler = std::move(handler)](const Message& a, const Message& b) {
               handler(MessageOf<A>{a}, MessageOf<B>{b});
             });
  }

  /// Called once, when parameters are set and links are open.
  void on_start(std::function<void()> handler) { start_ = std::move(handler); }
  /// Called once, when all inputs have ended, before the outputs do. Not after an error.
  void on_end(std::function<void()> handler) { end_ = std::move(handler); }
  /// For a module that makes messages by itself: called again and again while no message waits,
  /// until it gives false. The module ends then.
  void generate(std::function<bool()> handler) { generate_ = std::move(handler); }

  /// For generators: waits until the next period of a rate begins, counted from the first call.
  /// A module that is told to stop ends here. @param rate [Hz]
  void keep_rate(double rate);

  /// Says something to the person who runs the module: one line on standard error, with the
  /// module's name before it.
  void log(std::string_view line) const;

  /// Wall clock, for messages that begin here. [ns since the Unix epoch]
  [[nodiscard]] std::int64_t now() const { return clock_.wall(); }

  /// Runs the module as the command line says, until its inputs end, all its readers have gone, or
  /// it is told to stop (SIGINT, SIGTERM).
  /// @returns  what main() is to return: 0 done, 1 failure, 2 bad arguments.
  int run(int argc, char** argv);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& summary() const { return summary_; }
  [[nodiscard]] const auto& inputs() const { return inputs_; }
  [[nodiscard]] const auto& outputs() const { return outputs_; }
  [[nodiscard]] const auto& parameters() const { return parameters_; }

 private:
  friend void internal::send(internal::OutputState&, Message);
  struct Loop;

  /// Whether any output has a reader left.
  [[nodiscard]] bool is_read() const;

  std::shared_ptr<internal::InputState> add_input(std::string name, std::vector<PortType> types,
                                                  std::string doc);
  std::shared_ptr<internal::OutputState> add_output(std::string name, PortType type,
                                                    std::string doc);
  std::shared_ptr<ParameterState> add_parameter(std::string name, const ParameterValue& otherwise,
                                                std::string unit, std::string doc,
                                                ParameterOptions options);
  void add_pair(const std::shared_ptr<internal::InputState>& first,
                const std::shared_ptr<internal::InputState>& second,
                std::function<void(const Message&, const Message&)> handler);

  std::string name_, summary_;
  std::string instance_;  // its name in the graph
  std::vector<std::shared_ptr<internal::InputState>> inputs_;
  std::vector<std::shared_ptr<internal::OutputState>> outputs_;
  std::vector<std::shared_ptr<ParameterState>> parameters_;
  std::function<void()> start_, end_;
  std::function<bool()> generate_;
  SystemClock clock_;
  std::int64_t handled_time_ = 0;  // of the message being handled; 0: none
  std::int32_t handled_mode_ = 0;
  std::optional<MonotonicTime> next_period_;
};

}  // namespace hc
