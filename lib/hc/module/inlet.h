// SPDX-License-Identifier: Apache-2.0
#pragma once
// An inlet of a module, and what becomes of its messages. Internal.

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

/// A link by which messages arrive: at one port, at all of them from standard input, or the focus.
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

  /// Whether a message may come that has not been taken.
  [[nodiscard]] bool is_open() const { return source != nullptr && !head; }
  /// When its head is due.
  [[nodiscard]] MonotonicTime time() const { return MonotonicTime(head->header.time); }
  [[nodiscard]] bool is_same(const Inlet& other) const {
    return uri == other.uri && inputs == other.inputs;
  }
  [[nodiscard]] const std::string& port() const {
    return inputs.empty() ? kFocusPort : inputs.front()->name;
  }
  /// The inputs that its input is synchronised with; null: none.
  [[nodiscard]] TogetherState* together() const { return inputs.front()->together; }

  /// Adds the age of a message, and the time since the one before it.
  /// @param sensed  of its header.
  void measure(std::int64_t sensed, MonotonicTime taken, std::int64_t wall_offset);
  /// Its row of a report, which begins a new period of ages and gaps.
  LinkCounters take_counters();
};

}  // namespace internal

/// Passes messages to the handlers of their inputs, and drops those that cannot be handled.
class Module::Delivery {
 public:
  /// @param report_focus  called when the focus has changed.
  Delivery(Module& module, const internal::Now& now, internal::Trace& trace,
           std::function<void()> report_focus)
      : module_(module), now_(now), trace_(trace), report_focus_(std::move(report_focus)) {}

  /// Passes a message of an inlet to its handler, which may move it away, or to the focus.
  void handle(internal::Inlet& inlet, Message& message);
  /// Handles a complete set of synchronised inputs. @param inlet  of one of them.
  void handle(internal::Inlet& inlet, internal::TogetherState& together);
  void expire_focus() {
    if (module_.focus_.expire(now_.time())) report_focus_();
  }
  /// Whether a file or standard input had bad messages, so that the module has not done its work.
  [[nodiscard]] bool has_failed_input() const { return has_failed_input_; }

 private:
  void set_focus(internal::Inlet& inlet, const Message& message);
  void call(internal::Inlet& inlet, const internal::InputState& input, Message& message);
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
