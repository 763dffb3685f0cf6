// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a traced module reports of its messages over its output `trace` (spec/module.md): rows
// of text, written and read here alone. Pure.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// The output that every module with `control` has and does not list.
inline constexpr const char* kTracePort = "trace";

/// A moment in the way of a message.
struct TraceEvent {
  enum class What {
    Took,   ///< an input has taken it from its link
    Began,  ///< its handler begins, or with an empty port a timer's or the generator
    Ended,  ///< that has returned
    Sent,   ///< an output hands it to its links
    Lost,   ///< events were not noted since there were too many: `seq` says how many
  };
  What what = What::Took;
  std::string port;
  std::int32_t src = 0;     ///< with seq and time that of the message
  std::int64_t seq = 0;     ///< as in its header
  std::int64_t time = 0;    ///< as in its header [ns]
  std::int64_t moment = 0;  ///< wall clock, advanced by the monotonic one [ns]
  /// Which of the port's links; with an empty port, which timer (those of after() last), or
  /// kGenerator.
  std::int32_t number = 0;
  static constexpr std::int32_t kGenerator = -1;
  bool operator==(const TraceEvent&) const = default;
};

/// A string with a row "took PORT SRC SEQ TIME MOMENT" for each, and the number where it is not 0;
/// for an empty port "-".
Message make_trace(std::span<const TraceEvent> events);
/// Malformed rows are ignored.
std::vector<TraceEvent> read_trace(const Message& message);

}  // namespace hc
