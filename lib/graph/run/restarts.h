// SPDX-License-Identifier: Apache-2.0
#pragma once
// When a module that has ended is started again, and when it is given up. Pure: the time is passed
// in.

#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include <graph/run.h>
#include <hc/base/backoff.h>
#include <hc/base/clock.h>

namespace hc::internal {

/// The starts of one module.
///
/// The first few follow one another at once; then each is put off by a delay that doubles, uniform
/// between its half and its whole, so that many who lost the same thing do not come back together.
/// A run that was long enough makes all that came before forgotten.
class Restarts {
 public:
  static constexpr int kBadArguments = 2;  ///< exit status: a restart would fail again

  enum class Next {
    End,     ///< it has done its work
    Again,   ///< it is to be started once `delay` has passed
    GiveUp,  ///< it is not started again, though it has not done its work
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

  /// Notes that the module has been started.
  void started(MonotonicTime now);

  /// Says what follows its end. Status 2, bad arguments, would be the same again.
  Decision ended(int status, MonotonicTime now);

  /// Says what follows where it was lost with its host: the start does not count, as it has not
  /// failed.
  Decision lost(MonotonicTime now);

  /// Forgets all starts: somebody has changed what made it fail.
  void reset();
  void set_policy(Restart policy) { policy_ = policy; }

 private:
  void forget_after_long_run(MonotonicTime now);

  Restart policy_;
  RestartLimits limits_;
  std::minstd_rand random_;
  std::vector<MonotonicTime> starts_;  // within the window
  int delayed_ = 0;                    // starts that were put off,
  Backoff delay_;                      // and for how long
};

}  // namespace hc::internal
