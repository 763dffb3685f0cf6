// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's output `trace`: what happens to its messages, while the output is linked. Internal.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/clock.h>
#include <hc/contract/trace.h>
#include <hc/module/port.h>

namespace hc::internal {

class Trace {
 public:
  explicit Trace(const Clock& clock) : clock_(clock) { output.name = kTracePort; }

  [[nodiscard]] bool is_linked() const { return !output.links.empty(); }

  /// Notes an event of a message. @param number  of the link among those of its port.
  void note(TraceEvent::What what, const std::string& port, const Header& header,
            std::int32_t number = 0) {
    if (is_linked()) [[unlikely]]
      add({what, port, header.src, header.seq, header.time, clock_.wall(), number});
  }
  /// Notes an event without a message. @param number  of a timer, or TraceEvent::kGenerator.
  void note(TraceEvent::What what, std::int32_t number) {
    if (is_linked()) [[unlikely]]
      add({what, {}, 0, 0, {}, clock_.wall(), number});
  }

  /// Notes another value of a parameter.
  void note_set(const std::string& name, const std::string& value) {
    if (is_linked()) add({TraceEvent::What::Set, name, 0, 0, {}, clock_.wall(), 0, value});
  }
  /// Notes that a link of an output was added or removed.
  void note_link(TraceEvent::What what, const OutputState& of, const std::string& uri) {
    if (is_linked()) add({what, of.name, 0, of.seq, {}, clock_.wall(), 0, uri});
  }

  /// The wall clock, of which the reading is noted.
  Time read_clock() {
    const Time now = clock_.wall();
    if (is_linked()) [[unlikely]]
      add({TraceEvent::What::Read, {}, 0, 0, {}, now});
    return now;
  }

  /// Sends the events when there are many, or twice a second.
  void flush_if_due(MonotonicTime now) {
    if (!events_.empty() && (events_.size() >= kMany || now - flushed_ >= kPeriod)) flush();
  }
  /// Sends the events. A link that fails is closed, and the module goes on.
  void flush();

  OutputState output;

 private:
  static constexpr std::size_t kMany = 1000;
  static constexpr std::size_t kMost = 20'000;  // are kept; further ones are counted
  static constexpr std::chrono::milliseconds kPeriod{500};

  void add(TraceEvent event) {
    if (events_.size() < kMost)
      events_.push_back(std::move(event));
    else
      ++lost_;
  }

  const Clock& clock_;
  std::vector<TraceEvent> events_;
  std::int64_t lost_ = 0;
  MonotonicTime flushed_{0};
};

}  // namespace hc::internal
