// SPDX-License-Identifier: Apache-2.0
#pragma once
// Trace of a module's messages, sent over its output `trace` (spec/module.md): rows of text,
// formatted and parsed only here. Pure.

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// The implicit output of every module with `control`.
inline constexpr const char* kTracePort = "trace";

/// Identifies a message in traces, by its header.
struct MessageKey {
  std::int32_t src = 0;
  std::int64_t seq = 0;
  Time time;
  static MessageKey of(const Header& header) { return {header.src, header.seq, header.time}; }
  auto operator<=>(const MessageKey&) const = default;
};

/// An event in the life of a message, a change of a parameter or an output's link, or a reading of
/// the clock.
struct TraceEvent {
  enum class What {
    Took,      ///< an input took the message from its link
    Began,     ///< a handler began; with an empty port, that of a timer or the generator
    Ended,     ///< the handler returned
    Sent,      ///< an output passed the message to its links
    Lost,      ///< too many events: `seq` of them were not recorded
    Set,       ///< the parameter `port` was given another value
    Read,      ///< the module read its clock, which was `moment`
    Linked,    ///< a command linked the output `port` to the URI `value` after `seq` messages
    Unlinked,  ///< a command removed such a link after `seq` messages
  };
  What what = What::Took;
  std::string port;
  std::int32_t src = 0;  ///< of the message's header, as seq and time
  std::int64_t seq = 0;
  Time time;
  Time moment;  ///< advanced by the monotonic clock
  /// Index of the port's link; with an empty port, of the timer (those of after() last), or
  /// kGenerator.
  std::int32_t number = 0;
  static constexpr std::int32_t kGenerator = -1;
  std::string value = {};  ///< of a parameter, as text; the URI of a link
  [[nodiscard]] MessageKey key() const { return {src, seq, time}; }
  bool operator==(const TraceEvent&) const = default;
};

/// A string with a row "took PORT SRC SEQ TIME MOMENT" per event, followed by the number unless it
/// is 0; an empty port is "-". A change of a parameter is "set NAME MOMENT VALUE", of a link
/// "linked PORT SEQ MOMENT URI".
Message make_trace(std::span<const TraceEvent> events);
/// Malformed rows are ignored.
std::vector<TraceEvent> read_trace(const Message& message);

}  // namespace hc
