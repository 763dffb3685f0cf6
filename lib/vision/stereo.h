// SPDX-License-Identifier: Apache-2.0
#pragma once
// Depth from a rectified stereo pair: a left and a right image whose rows correspond. No
// messages.

#include <cstdint>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace hc::vision {

/// How images are matched.
struct StereoOptions {
  int disparities = 128;  ///< searched, from 0 on [px]; a multiple of 16
  int block_size = 5;     ///< side of the window that is compared, odd [px]
};

/// Semi-global matching, in OpenCV's three-way mode.
/// Source: Hirschmüller, Stereo Processing by Semiglobal Matching and Mutual Information, 2008.
class StereoMatcher {
 public:
  explicit StereoMatcher(const StereoOptions& options);

  /// Disparities of the left image's pixels.
  ///
  /// @param left, right  (H, W) or (H, W, 3) u8, of the same size, wider than the disparities
  ///     searched (OpenCV 4.6 writes where it should not otherwise), H > 0.
  /// @param[out] disparity  (H, W) f32 [px], 0 where unknown; written in place when it has that
  ///     size and type already.
  /// Cost: 100 ms at 800×600 and 128 disparities on one core.
  void match(const cv::Mat& left, const cv::Mat& right, cv::Mat& disparity);

  /// Whether images of this size can be matched.
  [[nodiscard]] bool takes(cv::Size size) const {
    return size.height > 0 && size.width > matcher_->getNumDisparities();
  }

 private:
  cv::Ptr<cv::StereoSGBM> matcher_;
  cv::Mat left_grey_, right_grey_, sixteenths_;
};

/// The geometry of a rectified pair.
struct StereoGeometry {
  double focal = 0;     ///< focal length of the rectified images [px]
  double baseline = 0;  ///< distance of the two cameras [m]
  double offset = 0;    ///< disparity of a point infinitely far away, negated [px]
};

/// depth = focal · baseline / (disparity + offset), along the optical axis; 0 stays 0, unknown.
///
/// @param disparity  (H, W) f32 [px].
/// @param[out] depth  (H, W) f32 [m].
void depth_of(const cv::Mat& disparity, const StereoGeometry& geometry, cv::Mat& depth);

/// How good disparities are, in counts of pixels.
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
/// @param truth  (H, W) u8, 0: unknown; in units of 1 / `truth_scale` pixels.
/// @param threshold  a larger error is bad [px].
StereoScore score(const cv::Mat& disparity, const cv::Mat& truth, double truth_scale,
                  double threshold);

}  // namespace hc::vision
