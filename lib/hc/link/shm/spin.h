// SPDX-License-Identifier: Apache-2.0
#pragma once
// Polls shared memory for a while before a reader sleeps. Internal. Used by one thread.

#include <chrono>
#include <functional>
#include <span>
#include <vector>

#include <hc/link/link.h>

namespace hc::internal {

/// The first part of a wait, which finds an imminent message without a system call.
///
/// It is skipped after a wait much longer than the spin, since the next message is then unlikely to
/// come soon: a module with a camera at 30 Hz would waste 20 µs per image.
class Spin {
 public:
  using Clock = std::chrono::steady_clock;

  /// Spins as long as the sources ask for, at most `timeout` (below 0: no limit). Returns whether
  /// one of them has a message, or `poll`, which is called every millisecond, returned true.
  ///
  /// Errors: those of `poll`.
  Result<bool> run(std::span<Source* const> sources, std::chrono::nanoseconds timeout,
                   const std::function<Result<bool>()>& poll);
  /// Tells how long the reader slept afterwards.
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
