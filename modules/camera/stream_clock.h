// SPDX-License-Identifier: Apache-2.0
#pragma once
// Maps the times of a live stream to the clock of this machine. Pure.

#include <chrono>
#include <optional>

#include <hc/base/time.h>

/// A stream says how far apart its images were taken, but not when, and they arrive late by a delay
/// that changes: in bursts, or after a network has been busy. The image with the least delay of the
/// last 10 to 20 s tells when the stream began, as this machine sees it; all times follow from
/// that. So they are late by the least delay, however the images arrive. They never decrease while
/// those of the stream increase.
class StreamClock {
 public:
  /// When an image was taken, at the latest: `arrived`.
  /// @param streamed  the time in the stream; if it does not increase, the stream has started
  /// again.
  hc::MonotonicTime time_of(std::chrono::nanoseconds streamed, hc::MonotonicTime arrived);

 private:
  using Offset = std::optional<std::chrono::nanoseconds>;  // from stream to machine, with the delay

  Offset least_, least_before_;  // of this period and the one before
  hc::MonotonicTime period_begin_{0};
  std::optional<std::chrono::nanoseconds> last_;
};
