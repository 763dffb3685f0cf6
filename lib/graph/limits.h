// SPDX-License-Identifier: Apache-2.0
#pragma once
// How patient a graph is with its modules.

#include <chrono>
#include <cstddef>

namespace hc {

/// How often a module is restarted.
struct RestartLimits {
  std::size_t starts_at_once = 5;                              ///< so many …
  std::chrono::nanoseconds window = std::chrono::seconds(10);  ///< … within this time
  std::chrono::nanoseconds first_delay = std::chrono::milliseconds(100);
  std::chrono::nanoseconds longest_delay = std::chrono::seconds(30);
  int delayed_starts = 8;  ///< so many with a delay, none of which ran for `window`: given up
};

struct SupervisionLimits {
  RestartLimits restarts;
  std::chrono::nanoseconds grace = std::chrono::seconds(5);  ///< between SIGTERM and SIGKILL
  /// Without a report from a module that has reported before: stalled.
  std::chrono::nanoseconds stall = std::chrono::milliseconds(1500);
  /// For the first report of a module that takes commands and has a `hang`, where that is not
  /// longer: it may have to load what it needs.
  std::chrono::nanoseconds first_report = std::chrono::seconds(60);
};

}  // namespace hc
