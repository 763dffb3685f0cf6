// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a link does when its reader is slow, or is to be spared: how many messages wait, how much
// memory they take, and how fast they go. Internal. Pure: time is passed in.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/base/uri.h>

namespace hc::internal {

using TimePoint = std::chrono::steady_clock::time_point;

/// The options that say so, of a sink; of shm, `rate` and `burst` are its source's.
struct Policy {
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  /// Messages that wait for a slow reader before the oldest is dropped; kAll: the writer waits, and
  /// none is dropped.
  std::size_t keep = kAll;
  std::uint64_t rate = 0;   ///< [message/s]; 0: as fast as they come
  std::uint64_t burst = 1;  ///< messages that may follow at once when none came for long
  std::uint64_t memory = std::uint64_t{64} << 20;  ///< of the messages that wait [byte]
  std::chrono::seconds timeout{0};  ///< of a writer that waits; 0: none. See Patience

  [[nodiscard]] bool writer_waits() const { return keep == kAll; }
  [[nodiscard]] bool is_paced() const { return rate > 0; }
};

/// Reads `keep=all|latest|N`, `rate=`, `burst=` (default 1) and `memory=`, which is bytes, perhaps
/// with a suffix K, M or G (of 1024), and `timeout=` [s].
///
/// Errors: Invalid; also for a burst without its rate.
Result<Policy> parse_policy(const Uri& uri);

/// Lets `rate` messages a second pass, and `burst` at once when none passed for long. Exact:
/// integers alone.
class TokenBucket {
 public:
  /// Full at first. Both up to kMost; rate 0: no limit.
  TokenBucket(std::uint64_t rate, std::uint64_t burst);
  static constexpr std::uint64_t kMost = std::uint64_t{1} << 32;

  /// When one may pass: `now`, or later if none passes until then.
  TimePoint ready_at(TimePoint now);
  /// Has one pass, which is ready.
  void take(TimePoint now);
  /// Whether there is a limit; without one, no time needs to be known.
  [[nodiscard]] bool limited() const { return rate_ > 0; }

 private:
  void fill(TimePoint now);

  std::int64_t rate_;      // [1e-9 token/ns]
  std::int64_t capacity_;  // [1e-9 token]
  std::int64_t level_;     // the same
  TimePoint filled_ = TimePoint::min();
};

/// How a writer that loses nothing waits for one reader: it says so when that takes long, and gives
/// the reader up when that has taken nothing for the policy's `timeout`. From then on messages to
/// it are dropped, until it takes some again. One rule for all transports.
class Patience {
 public:
  /// So long a wait is said: a reader that gets through is not worth it.
  static constexpr std::chrono::milliseconds kLong{200};

  /// @param timeout  0: it is waited for as long as it takes.
  /// @param tell  called with true when a wait gets long, with false when it ends; may be empty.
  /// @param log  gets a line when the reader is given up, and when it takes messages again.
  explicit Patience(std::chrono::seconds timeout = {}, std::function<void(bool)> tell = {},
                    LogSink log = {})
      : timeout_(timeout), tell_(std::move(tell)), log_(std::move(log)) {}

  /// Looks at a reader before each wait for it, when it has `taken` so much, in whatever unit.
  /// @returns  whether to wait, until due() at most; if not, it has just been given up.
  bool waits(std::uint64_t taken, TimePoint now);
  /// There is room for a message, or the wait was given up.
  void end();
  [[nodiscard]] TimePoint due() const;

  /// Whether it is given up still; it is not when it has taken something since.
  bool is_over(std::uint64_t taken);
  [[nodiscard]] bool is_over() const { return is_over_; }
  /// It is waited for again, whatever it has taken.
  void renew() { is_over_ = false; }

 private:
  std::chrono::seconds timeout_;
  std::function<void(bool)> tell_;
  LogSink log_;
  std::uint64_t taken_ = 0;
  std::optional<TimePoint> began_, last_taken_;  // the wait, and the reader's last sign in it
  bool is_told_ = false, is_over_ = false;
};

}  // namespace hc::internal
