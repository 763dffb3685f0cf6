// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a module notes of its messages while somebody traces it: while its output `trace` is linked.
// Internal.

#include <cstdint>
#include <string>
#include <vector>

#include <hc/base/clock.h>
#include <hc/contract/trace.h>
#include <hc/module/port.h>

namespace hc::internal {

struct Trace {
  static constexpr std::size_t kMany = 1000;    ///< events, after which they are sent
  static constexpr std::size_t kMost = 20'000;  ///< that are kept until then

  explicit Trace(const Clock& machine) : clock(machine) { output.name = kTracePort; }

  const Clock& clock;
  OutputState output;
  std::vector<TraceEvent> events;
  std::int64_t lost = 0;
  MonotonicTime sent{0};

  void note(TraceEvent::What what, const std::string& port, const Header& header,
            std::int32_t number) {
    if (events.size() < kMost)
      events.push_back({what, port, header.src, header.seq, header.time, clock.wall(), number});
    else
      ++lost;
  }

  /// Sends what was noted. A link that fails is over: nothing here ends the module.
  void flush();
};

}  // namespace hc::internal
