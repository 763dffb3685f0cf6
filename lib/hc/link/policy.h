// SPDX-License-Identifier: Apache-2.0
#pragma once
// Flow control of a link: how many messages are queued, how much memory they use, and at what rate
// they are sent. Internal. Pure: time is passed in.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
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
  std::uint64_t rate = 0;       ///< [message/s]; 0: unlimited
  std::uint64_t burst = 1;      ///< messages that may be sent at once after a pause
  std::uint64_t bandwidth = 0;  ///< as on the wire [byte/s]; 0: unlimited
  std::uint64_t memory = std::uint64_t{64} << 20;  ///< of queued messages [byte]
  std::chrono::seconds timeout{0};                 ///< of a waiting writer, see Patience; 0: none

  [[nodiscard]] bool writer_waits() const { return keep == kAll; }
  [[nodiscard]] bool is_paced() const { return rate > 0 || bandwidth > 0; }
};

/// Parses `keep=all|latest|N`, `rate=`, `burst=` (default 1), `memory=` [byte], optionally with a
/// suffix K, M or G (of 1024), `timeout=` [s], and `bandwidth=`, see parse_bandwidth().
///
/// Errors: Invalid; also for `burst` without `rate`.
Result<Policy> parse_policy(const Uri& uri);

/// Parses a number of bytes or bits a second, such as `2 MB/s`, `500kB/s` or `5 Mbit/s` (units of
/// 1000), without a unit [byte/s].
///
/// Errors: Invalid; also outside 1 kB/s … 4 GB/s.
Result<std::uint64_t> parse_bandwidth(std::string_view text);

/// A token bucket: lets `rate` messages or bytes per second pass, and up to `burst` at once after a
/// pause. Integer arithmetic, exact.
class TokenBucket {
 public:
  /// Initially full. Both at most kMost; rate 0: no limit.
  TokenBucket(std::uint64_t rate, std::uint64_t burst);
  static constexpr std::uint64_t kMost = std::uint64_t{1} << 32;

  /// When so much may pass: `now`, or a later time if nothing passes before. More than `burst`
  /// passes when the bucket is full, and what follows waits for the rest.
  TimePoint ready_at(TimePoint now, std::uint64_t amount = 1);
  /// Takes tokens; ready_at() must have returned `now`.
  void take(TimePoint now, std::uint64_t amount = 1);
  /// Whether there is a limit; without one, the current time does not matter.
  [[nodiscard]] bool limited() const { return rate_ > 0; }

 private:
  void fill(TimePoint now);

  std::int64_t rate_;      // [1e-9 token/ns]
  std::int64_t capacity_;  // [1e-9 token]
  std::int64_t level_;     // [1e-9 token]
  TimePoint filled_ = TimePoint::min();
};

/// The pace of a link: `rate` and `burst` in messages, and `bandwidth` in bytes. In any second, at
/// most 1/40 of its bytes pass in addition, or one message, whichever is more.
class Pace {
 public:
  explicit Pace(const Policy& policy)
      : messages_(policy.rate, policy.burst),
        bytes_(policy.bandwidth, policy.bandwidth / kBursts) {}

  /// When a message of this size may pass, as TokenBucket::ready_at(). A size that is unknown until
  /// the message has been taken is 1.
  TimePoint ready_at(TimePoint now, std::uint64_t bytes) {
    return std::max(messages_.ready_at(now), bytes_.ready_at(now, bytes));
  }
  void take(TimePoint now, std::uint64_t bytes) {
    messages_.take(now);
    bytes_.take(now, bytes);
  }
  [[nodiscard]] bool limited() const { return messages_.limited() || bytes_.limited(); }

 private:
  static constexpr std::uint64_t kBursts = 40;  // in a second
  TokenBucket messages_, bytes_;
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
