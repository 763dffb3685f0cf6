// SPDX-License-Identifier: Apache-2.0
#pragma once
// Limits the log of a process per second. Pure: the time is a parameter.

#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <hc/base/clock.h>

namespace hc {

/// Counts over periods of a second, each starting with its first line.
class LogLimit {
 public:
  static constexpr std::uint64_t kMostLines = 10'000, kMostBytes = std::uint64_t{256} << 10;
  static constexpr std::chrono::seconds kPeriod{1};
  /// Between reads of 64 KiB from a process above the limit.
  static constexpr std::chrono::milliseconds kPause{10};

  /// Returns whether a line is within the limit; otherwise counts it as dropped.
  bool passes(std::uint64_t bytes, MonotonicTime now) {
    if (now - begun_ >= kPeriod && dropped_ == 0) {
      begun_ = now;
      lines_ = bytes_ = 0;
    }
    ++lines_;
    bytes_ += bytes;
    if (lines_ <= kMostLines && bytes_ <= kMostBytes) return true;
    ++dropped_;
    return false;
  }

  /// Whether lines are being dropped.
  [[nodiscard]] bool is_over() const { return dropped_ > 0; }

  /// Returns a log line about dropped lines once their second has passed; empty: none.
  std::string take_remark(MonotonicTime now) {
    if (dropped_ == 0 || now - begun_ < kPeriod) return "";
    const auto time = std::chrono::duration<double>(now - begun_).count();
    begun_ = now;
    lines_ = bytes_ = 0;
    return std::to_string(std::exchange(dropped_, 0)) + " lines dropped in " +
           std::to_string(std::lround(time)) + " s: more than " + std::to_string(kMostBytes >> 10) +
           " kB or " + std::to_string(kMostLines) + " lines in a second";
  }

 private:
  MonotonicTime begun_{-kPeriod};
  std::uint64_t lines_ = 0, bytes_ = 0, dropped_ = 0;
};

}  // namespace hc
