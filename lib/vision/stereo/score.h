// SPDX-License-Identifier: Apache-2.0
#pragma once
// Scores disparities against ground truth.

#include <cmath>
#include <cstdint>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Counts of pixels.
struct StereoScore {
  std::int64_t truth = 0;  ///< pixels whose true disparity is known
  std::int64_t holes = 0;  ///< of these, without a disparity
  std::int64_t bad = 0;    ///< of these, off by more than the threshold

  [[nodiscard]] std::int64_t valid() const { return truth - holes; }
  [[nodiscard]] double bad_share() const { return share(bad, valid()); }   ///< of the valid
  [[nodiscard]] double hole_share() const { return share(holes, truth); }  ///< of the known
  [[nodiscard]] double wrong_share() const { return share(bad + holes, truth); }

 private:
  static double share(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
  }
};

/// Compares disparities with the true ones.
///
/// @param disparity  (H, W) f32 [px], 0: unknown.
/// @param truth  (H, W) f32 [px], 0: unknown.
/// @param threshold  a larger error is bad [px].
inline StereoScore score(const cv::Mat& disparity, const cv::Mat& truth, double threshold) {
  CV_Assert(disparity.size() == truth.size() && disparity.type() == CV_32F &&
            truth.type() == CV_32F);
  StereoScore score;
  for (int y = 0; y < truth.rows; ++y) {
    const auto* found = disparity.ptr<float>(y);
    const auto* known = truth.ptr<float>(y);
    for (int x = 0; x < truth.cols; ++x) {
      if (known[x] <= 0) continue;
      ++score.truth;
      if (found[x] <= 0)
        ++score.holes;
      else if (std::abs(double{found[x]} - known[x]) > threshold)
        ++score.bad;
    }
  }
  return score;
}

}  // namespace hc::vision
