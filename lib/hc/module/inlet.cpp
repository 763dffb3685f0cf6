// SPDX-License-Identifier: Apache-2.0
#include <hc/module/inlet.h>

#include <algorithm>
#include <utility>

#include <hc/compress/compress.h>
#include <hc/module/ending.h>
#include <hc/mtp/matrix_view.h>

namespace hc {
namespace {

using internal::Inlet;

/// Median, 99th percentile and maximum since the last call.
Durations take_durations(internal::Quantiles& quantiles) {
  if (quantiles.empty()) return {-1, -1, -1};
  const Durations taken = {quantiles.quantile(0.5), quantiles.quantile(0.99), quantiles.max()};
  quantiles.clear();
  return taken;
}

/// Why a message fits no input of its link.
Error misfit_of(const Inlet& inlet, const Message& message) {
  if (inlet.inputs.size() == 1) return misfit(message.header, inlet.inputs.back()->types);
  std::string takers;
  for (const auto* input : inlet.inputs)
    takers += (takers.empty() ? "" : ", ") + input->name + " takes " + in_words(input->types);
  return {Code::Malformed, in_words(message.header) + " fits no input: " + takers};
}

}  // namespace

void Inlet::measure(Time sensed, MonotonicTime taken, std::chrono::nanoseconds wall_offset) {
  if (sensed != Time()) ages.add((Time(taken + wall_offset) - sensed).count());
  if (last_taken.count() != 0) gaps.add((taken - last_taken).count());
  last_taken = taken;
}

LinkCounters Inlet::take_counters() {
  LinkCounters row;
  row.traffic = past;
  if (source != nullptr) {
    row.traffic += source->traffic();
    if (const auto peers = source->peers()) row.peers = static_cast<std::int64_t>(*peers);
  }
  row.traffic.bad += bad;
  if (together() != nullptr && together()->is_latest)
    row.traffic.dropped_newer +=
        together()->dropped_newer + together()->matcher.dropped(inputs.front()->place).total();
  row.ignored = ignored;
  row.age = take_durations(ages);
  row.gap = take_durations(gaps);
  return row;
}

void Module::Delivery::handle(Inlet& inlet, Message& message) {
  if (inlet.inputs.empty()) return set_focus(inlet, message);
  for (auto* input : inlet.inputs) {
    const bool fits_any =
        input->types.empty() ||
        std::any_of(input->types.begin(), input->types.end(),
                    [&](const PortType& type) { return fits(message.header, type); });
    if (!fits_any) continue;
    trace_.note(TraceEvent::What::Took, input->name, message.header, inlet.number);
    if (!input->handler && !input->is_pulled) return;
    if (!module_.focus_.admits(input->is_exclusive, message.header.mode)) {
      ++inlet.ignored;
      return;
    }
    if (input->is_raw || message.plain()) return call(inlet, *input, message);
    auto plain = expand(message);
    if (!plain) return drop(inlet, input->name, plain.error().text());
    return call(inlet, *input, *plain);
  }
  drop(inlet, inlet.inputs.size() == 1 ? inlet.port() : inlet.uri,
       misfit_of(inlet, message).text());
}

void Module::Delivery::handle(Inlet& inlet, internal::TogetherState& together) {
  call_or_drop(inlet, inlet.port(), [&] { module_.handle(together); });
}

void Module::Delivery::call(Inlet& inlet, internal::InputState& input, Message& message) {
  if (input.is_finite && !finite(message)) {
    ++inlet.ignored;
    return module_.log_once("not finite", input.name + ": dropped: NaN or infinity");
  }
  if (!input.handler) return keep_waiting(inlet, input, message);
  module_.handled_ = internal::Handled(message.header, &inlet.route.peer);
  call_or_drop(inlet, input.name, [&] {
    if (!trace_.is_linked() || input.together != nullptr) [[likely]]
      return input.handler(message);
    const Header header = message.header;  // a handler may move the message away
    trace_.note(TraceEvent::What::Began, input.name, header, inlet.number);
    input.handler(message);
    trace_.note(TraceEvent::What::Ended, input.name, header, inlet.number);
  });
  module_.handled_ = {};
}

/// A link of one input waits as long as a message of it does. Standard input has messages of
/// several, of which a script may not read one.
void Module::Delivery::keep_waiting(Inlet& inlet, internal::InputState& input, Message& message) {
  constexpr std::size_t kMost = 16;
  input.waiting.push_back({std::move(message).keep(), inlet.number});
  if (inlet.inputs.size() == 1 || input.waiting.size() <= kMost) return;
  input.waiting.pop_front();
  module_.log_once("not read", input.name + ": dropped: the script does not read it");
}

/// Calls a handler. Any exception except ModuleError means a bad message: also those of libraries
/// that do not accept every image.
template <typename Handle>
void Module::Delivery::call_or_drop(Inlet& inlet, const std::string& who, const Handle& handle) {
  try {
    handle();
  } catch (const ModuleError&) {
    throw;
  } catch (const std::exception& why) {
    module_.handled_ = {};
    drop(inlet, who, internal::thrown_in_words(why));
  }
}

/// Drops a message; the link goes on. The first one is logged.
void Module::Delivery::drop(Inlet& inlet, const std::string& who, std::string_view why) {
  ++inlet.bad;
  if (inlet.uri == "-" || inlet.uri.starts_with("file:")) has_failed_input_ = true;
  module_.log_once("bad at " + who,
                   who + ": dropped: " + std::string(why.substr(0, why.find('\n'))));
}

void Module::Delivery::set_focus(Inlet& inlet, const Message& message) {
  auto& focus = module_.focus_;
  const auto modes = view<std::int32_t>(message);
  if (!modes) return drop(inlet, inlet.port(), modes.error().detail);
  if (modes->empty()) return drop(inlet, inlet.port(), "it has no mode");
  trace_.note(TraceEvent::What::Took, inlet.port(), message.header);
  focus.received = now_.time();
  if (std::exchange(focus.current, modes->at(0, 0)) != focus.current) report_focus_();
}

}  // namespace hc
