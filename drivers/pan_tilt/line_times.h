// SPDX-License-Identifier: Apache-2.0
#pragma once
// When a pan-tilt unit was at a position that it reports over a slow line. Pure: times come from
// the caller and do not decrease.

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>

#include <hc/base/clock.h>

namespace hc::pan_tilt {

/// The times of positions, which a unit reports as pairs of answers: first pan, then tilt.
///
/// A unit reports its position when the question arrives, after all earlier bytes. The answer takes
/// time, too, and follows earlier answers on the line. Half of the least remaining delay of the
/// recent answers is assumed to be before the report; what exceeds it, the host was late to read.
class LineTimes {
 public:
  /// The rate of bytes in each direction [1/s]; 0 (default): infinite.
  void set_rate(double bytes_per_second) { bytes_per_second_ = bytes_per_second; }
  /// Forgets all questions and answers, at the start of a line or after a fault.
  void forget();

  /// The host is to write `bytes` bytes, after those before.
  void queued(std::size_t bytes) { unsent_ += bytes; }
  /// They end with the question for the pan; that for the tilt follows.
  void asked(MonotonicTime now);
  /// The host writes all that is queued.
  void wrote(MonotonicTime now);

  /// An answer of any kind is complete. @param begins  it is the pan of a pair.
  void answered(MonotonicTime now, bool begins);
  /// A pair of answers is complete. Call once after asked(), in order.
  ///
  /// @param bytes  length of both answers.
  /// @returns  when the question was written.
  MonotonicTime heard(std::size_t bytes);
  /// When the unit was at the pan of the last pair.
  MonotonicTime seen_at(MonotonicTime now);
  /// The tilt at the time of the pan; interpolated, since its question arrived a little later.
  ///
  /// @param time  of the pan.
  /// @param seen  the tilt as reported [rad].
  /// @param bytes  length of its question.
  double tilt_at(MonotonicTime time, double seen, std::size_t bytes);

 private:
  struct Look {
    MonotonicTime time{0};  // when its question was written
    MonotonicTime sent{0};  // when the last byte of that left
  };
  struct Tilt {
    MonotonicTime time;  // of the pan
    double seen;
  };
  [[nodiscard]] std::chrono::nanoseconds on_line(std::size_t bytes) const;

  double bytes_per_second_ = 0;
  std::size_t unsent_ = 0;                         // queued bytes
  std::optional<std::size_t> unsent_question_;     // of these, up to the end of a question
  MonotonicTime written_{0};                       // when all bytes have left
  MonotonicTime answered_{0}, heard_after_{0};     // the last answer; the one before the pair
  std::deque<Look> looks_;                         // without an answer
  Look look_;                                      // of the last pair
  std::size_t heard_bytes_ = 0;                    // of the last pair
  std::optional<std::chrono::nanoseconds> delay_;  // least of recent answers
  std::optional<Tilt> tilt_;
};

}  // namespace hc::pan_tilt
