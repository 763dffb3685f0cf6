// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores how well a ball is followed, given its true position and visibility. Pure.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hc::gaze {

/// A sample of the truth.
struct TrackSample {
  double time;   ///< of any one clock [s]
  double error;  ///< angle between the gaze and the ball [rad]
  double share;  ///< visible share of the ball, 0 … 1
};

struct TrackScore {
  double rms = 0;                  ///< error while the ball is visible and acquired [rad]
  std::optional<double> acquired;  ///< time to acquire it after it is first visible [s]
  std::vector<double> again;       ///< the same for each return; < 0: never acquired [s]
  std::size_t samples = 0;         ///< in rms

  /// The longest of `again`; < 0 if one is; 0 if empty [s].
  [[nodiscard]] double longest() const;
  /// rms, acquired (-1: never), number of returns, longest(), samples.
  [[nodiscard]] std::array<double, 5> numbers() const;
  /// "RMS error 0.30°, acquired after 0.45 s, came back 0 times, …".
  [[nodiscard]] std::string text() const;
};

/// @param samples  in the order of time.
/// @param within  maximum error of an acquired ball [rad].
///
/// A ball becomes visible at a share of 0.5, and hidden at 0.1. After a return, errors count again
/// when it is acquired, or after 1 s. If it disappears, or the samples end, within that second, the
/// return does not count, since there was no time to acquire it.
TrackScore score_track(const std::vector<TrackSample>& samples, double within);

/// Collects the samples of a run.
class Track {
 public:
  /// Drops the samples so far; only the first call has an effect.
  void begin();
  void add(const TrackSample& sample) { samples_.push_back(sample); }
  /// From the first sample to the last [s].
  [[nodiscard]] double duration() const;
  /// @param within  as in score_track().
  [[nodiscard]] TrackScore score(double within) const { return score_track(samples_, within); }

 private:
  std::vector<TrackSample> samples_;
  bool has_begun_ = false;
};

}  // namespace hc::gaze
