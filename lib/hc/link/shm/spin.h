// SPDX-License-Identifier: Apache-2.0
#pragma once
// Looks at shared memory for a while before a reader sleeps. Internal. Of one thread.

#include <chrono>
#include <functional>
#include <span>
#include <vector>

#include <hc/link/link.h>

namespace hc::internal {

/// The part of a wait in which a message that is about to come is found without a system call.
///
/// Spinning pays only where the next message comes soon: not after a wait much longer than the
/// spin. A module with a camera at 30 Hz would burn 20 µs an image for nothing.
class Spin {
 public:
  using Clock = std::chrono::steady_clock;

  /// Spins as long as the sources ask for, at most `timeout` (below 0: no limit); whether one of
  /// them has a message, or `poll` has said so, which is called every millisecond.
  ///
  /// Errors: those of `poll`.
  Result<bool> run(std::span<Source* const> sources, std::chrono::nanoseconds timeout,
                   const std::function<Result<bool>()>& poll);
  /// How long the reader slept afterwards.
  void note_sleep(std::chrono::nanoseconds time) { last_wait_ = time; }

  /// Whether the last run() took about a microsecond at most.
  [[nodiscard]] bool was_short() const { return was_short_; }

 private:
  [[nodiscard]] bool look() const;

  std::vector<Source::Spin> words_;
  std::chrono::nanoseconds last_wait_{0};
  bool was_short_ = false;
};

}  // namespace hc::internal
