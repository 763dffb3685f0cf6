// SPDX-License-Identifier: Apache-2.0
#pragma once
// An inlet of a module, and the delivery of its messages. Internal.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hc/contract/report.h>
#include <hc/module/module.h>
#include <hc/module/quantiles.h>
#include <hc/module/timers.h>

namespace hc {

namespace internal {

/// The port of inlets that receive the focus.
inline const std::string kFocusPort = "focus";

/// A link by which messages arrive: at one input, at all (standard input), or of the focus.
struct Inlet {
  std::string uri;
  std::unique_ptr<Source> source = {};   ///< null after its end
  std::vector<InputState*> inputs = {};  ///< none: the focus
  std::optional<Message> head = {};      ///< by the messages' clock: taken, not yet handled
  Route route = {};                      ///< its peer
  std::int32_t number = 0;               ///< among the links of its port
  bool is_latest = false;                ///< keep=latest, of a synchronised input
  Traffic past = {};                     ///< of its earlier sources
  std::uint64_t ignored = 0;             ///< messages: another mode had the focus
  std::uint64_t bad = 0;                 ///< messages; see BadMessage
  Quantiles ages = {}, gaps = {};        ///< of messages since the last report
  MonotonicTime last_taken{0};           ///< 0: never

  /// Whether its next message is to be taken.
  [[nodiscard]] bool is_open() const { return source != nullptr && !head && !is_full(); }
  /// Whether a message of it waits to be pulled. Those of several inputs queue up: see Delivery.
  [[nodiscard]] bool is_full() const {
    return inputs.size() == 1 &&
           std::ranges::count(inputs[0]->waiting, number, &Waiting::inlet) > 0;
  }
  /// When its head is due, by the messages' clock.
  [[nodiscard]] MonotonicTime time() const {
    return std::min(head->header.time.time_since_epoch(), kLatest);
  }
  [[nodiscard]] bool is_same(const Inlet& other) const {
    return uri == other.uri && inputs == other.inputs;
  }
  [[nodiscard]] const std::string& port() const {
    return inputs.empty() ? kFocusPort : inputs.front()->name;
  }
  /// The synchronised inputs that its input is one of; null: none.
  [[nodiscard]] TogetherState* together() const { return inputs.front()->together; }

  /// Adds to the open links of its input, if it has but one.
  void count(std::int32_t added) const {
    if (inputs.size() == 1) inputs.front()->links += added;
  }
  /// Adds the age of a message, and the gap before it. @param sensed  time in its header.
  void measure(Time sensed, MonotonicTime taken, std::chrono::nanoseconds wall_offset);
  /// A row of a report; ages and gaps start again.
  LinkCounters take_counters();
};

}  // namespace internal

/// Passes messages to the handlers of their inputs, or drops them.
class Module::Delivery {
 public:
  /// @param report_focus  called after a change of the focus.
  Delivery(Module& module, const internal::Now& now, internal::Trace& trace,
           std::function<void()> report_focus)
      : module_(module), now_(now), trace_(trace), report_focus_(std::move(report_focus)) {}

  /// Handles a message, whose handler may move it away.
  void handle(internal::Inlet& inlet, Message& message);
  /// Handles a complete set of synchronised inputs. @param inlet  of one of them.
  void handle(internal::Inlet& inlet, internal::TogetherState& together);
  void expire_focus() {
    if (module_.focus_.expire(now_.time())) report_focus_();
  }
  /// Whether a file or standard input had bad messages: the module has failed then.
  [[nodiscard]] bool has_failed_input() const { return has_failed_input_; }

 private:
  void set_focus(internal::Inlet& inlet, const Message& message);
  void call(internal::Inlet& inlet, internal::InputState& input, Message& message);
  void keep_waiting(internal::Inlet& inlet, internal::InputState& input, Message& message);
  template <typename Handle>
  void call_or_drop(internal::Inlet& inlet, const std::string& who, const Handle& handle);
  void drop(internal::Inlet& inlet, const std::string& who, std::string_view why);

  Module& module_;
  const internal::Now& now_;
  internal::Trace& trace_;
  std::function<void()> report_focus_;
  bool has_failed_input_ = false;
};

}  // namespace hc
