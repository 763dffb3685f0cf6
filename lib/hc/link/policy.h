// SPDX-License-Identifier: Apache-2.0
#pragma once
// Flow control of a link: how many messages are queued, how much memory they use, and at what rate
// they are sent. Internal. Pure: time is passed in.

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

/// The options of flow control, of a sink; for shm, `rate` and `burst` belong to the source.
struct Policy {
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  /// Messages queued for a slow reader before the oldest is dropped; kAll: the writer waits
  /// instead.
  std::size_t keep = kAll;
  std::uint64_t rate = 0;   ///< [message/s]; 0: unlimited
  std::uint64_t burst = 1;  ///< messages that may be sent at once after a pause
  std::uint64_t memory = std::uint64_t{64} << 20;  ///< of queued messages [byte]
  std::chrono::seconds timeout{0};                 ///< of a waiting writer, see Patience; 0: none

  [[nodiscard]] bool writer_waits() const { return keep == kAll; }
  [[nodiscard]] bool is_paced() const { return rate > 0; }
};

/// Parses `keep=all|latest|N`, `rate=`, `burst=` (default 1), `memory=` [byte], optionally with a
/// suffix K, M or G (of 1024), and `timeout=` [s].
///
/// Errors: Invalid; also for `burst` without `rate`.
Result<Policy> parse_policy(const Uri& uri);

/// A token bucket: lets `rate` messages per second pass, and up to `burst` at once after a pause.
/// Integer arithmetic, exact.
class TokenBucket {
 public:
  /// Initially full. Both at most kMost; rate 0: no limit.
  TokenBucket(std::uint64_t rate, std::uint64_t burst);
  static constexpr std::uint64_t kMost = std::uint64_t{1} << 32;

  /// When a message may pass: `now`, or a later time if none passes before.
  TimePoint ready_at(TimePoint now);
  /// Takes a token, which must be available.
  void take(TimePoint now);
  /// Whether there is a limit; without one, the current time does not matter.
  [[nodiscard]] bool limited() const { return rate_ > 0; }

 private:
  void fill(TimePoint now);

  std::int64_t rate_;      // [1e-9 token/ns]
  std::int64_t capacity_;  // [1e-9 token]
  std::int64_t level_;     // [1e-9 token]
  TimePoint filled_ = TimePoint::min();
};

/// How long a writer with `keep=all` waits for a reader: it reports a long wait, and gives up the
/// reader if that has read nothing for `timeout`. Messages to it are then dropped until it reads
/// again. The same for all transports.
class Patience {
 public:
  /// Waits this long are reported.
  static constexpr std::chrono::milliseconds kLong{200};

  /// @param timeout  0: unlimited.
  /// @param on_long_wait  called with true when a wait becomes long, and with false when it ends;
  ///     may be empty.
  /// @param log  takes a line when the reader is given up, and when it reads again.
  explicit Patience(std::chrono::seconds timeout = {}, std::function<void(bool)> on_long_wait = {},
                    LogSink log = {})
      : timeout_(timeout), on_long_wait_(std::move(on_long_wait)), log_(std::move(log)) {}

  /// Checks a reader before each wait for it. `taken` counts what it has read, in any unit.
  /// @returns  whether to wait, until due() at most; false if it has just been given up.
  bool waits(std::uint64_t taken, TimePoint now);
  /// Ends a wait: there is room for the message, or the wait was aborted.
  void end();
  [[nodiscard]] TimePoint due() const;

  /// Whether the reader has been given up and has not read since.
  bool is_over(std::uint64_t taken);
  [[nodiscard]] bool is_over() const { return is_over_; }
  /// Waits for the reader again, whether or not it has read.
  void renew() { is_over_ = false; }

 private:
  std::chrono::seconds timeout_;
  std::function<void(bool)> on_long_wait_;
  LogSink log_;
  std::uint64_t taken_ = 0;
  std::optional<TimePoint> began_, last_taken_;  // the wait, and the reader's last progress in it
  bool is_reported_ = false, is_over_ = false;
};

}  // namespace hc::internal
