// SPDX-License-Identifier: Apache-2.0
#pragma once
// How well a ball is followed, of which is known where it is and whether it can be seen. Pure.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hc::gaze {

/// One look at the truth.
struct TrackSample {
  double time;   ///< [s], of any origin
  double error;  ///< angle between the gaze and the ball [rad]
  double share;  ///< of the ball that is seen, 0 … 1
};

struct TrackScore {
  double rms = 0;                  ///< error while the ball is seen and had been acquired [rad]
  std::optional<double> acquired;  ///< from the first time that the ball is seen [s]
  std::vector<double> again;       ///< the same each time that it comes back; below 0: never [s]
  std::size_t samples = 0;         ///< of which rms is

  /// The longest of `again`; below 0: never once; 0 without any [s].
  [[nodiscard]] double longest() const;
  /// rms, acquired (-1: never), how often it came back, longest(), samples.
  [[nodiscard]] std::array<double, 5> numbers() const;
  /// "RMS error 0.30°, acquired after 0.45 s, came back 0 times, …".
  [[nodiscard]] std::string text() const;
};

/// @param samples  in the order of time.
/// @param within  an error up to this has acquired the ball [rad].
///
/// A ball is seen from a share of a half on, and hidden from a tenth down. After it has come back,
/// errors count again when it is acquired again, or after 1 s. If it goes, or the samples end,
/// within that second, there was no time to acquire it: that return does not count.
TrackScore score_track(const std::vector<TrackSample>& samples, double within);

/// The samples of a run, to be scored.
class Track {
 public:
  /// Drops the samples so far; only the first call has an effect.
  void begin();
  void add(const TrackSample& sample) { samples_.push_back(sample); }
  /// From the first sample to the last [s].
  [[nodiscard]] double duration() const;
  /// @param within  as of score_track().
  [[nodiscard]] TrackScore score(double within) const { return score_track(samples_, within); }

 private:
  std::vector<TrackSample> samples_;
  bool has_begun_ = false;
};

}  // namespace hc::gaze
