// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides when to restart an ended module, and when to give up. Pure: the time is a parameter.

#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include <graph/run.h>
#include <hc/base/backoff.h>
#include <hc/base/clock.h>

namespace hc::internal {

/// The restarts of one module.
///
/// The first few are immediate; then a delay doubles each time, randomly reduced by up to a half,
/// so that modules that failed together do not restart together. A long run resets the count.
class Restarts {
 public:
  static constexpr int kBadArguments = 2;  ///< exit status: a restart would fail again

  enum class Next {
    End,     ///< it has done its work
    Again,   ///< start it after `delay`
    GiveUp,  ///< it has failed permanently
  };
  struct Decision {
    Next next = Next::End;
    std::chrono::nanoseconds delay{0};
  };

  Restarts(Restart policy, const RestartLimits& limits, std::uint32_t seed)
      : policy_(policy),
        limits_(limits),
        random_(seed),
        delay_(limits.first_delay, limits.longest_delay) {}

  void started(MonotonicTime now);

  /// Decides after its end.
  Decision ended(int status, MonotonicTime now);

  /// Decides after the connection to its host was lost: that start does not count.
  Decision lost(MonotonicTime now);

  /// Forgets all starts, since the cause of failures may have been fixed.
  void reset();
  void set_policy(Restart policy) { policy_ = policy; }

 private:
  void forget_after_long_run(MonotonicTime now);

  Restart policy_;
  RestartLimits limits_;
  std::minstd_rand random_;
  std::vector<MonotonicTime> starts_;  // within the window
  int delayed_ = 0;                    // starts with a delay
  Backoff delay_;
};

}  // namespace hc::internal
