// SPDX-License-Identifier: Apache-2.0
#pragma once
// Disparities of a rectified stereo pair: a left and a right image whose rows correspond.

#include <memory>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// What a matcher finds, for each pixel of the left image. Matrices that have their size and type
/// already are written in place.
struct Disparities {
  cv::Mat disparity;   ///< (H, W) f32 [px], how far left the same point is in the right image; 0
                       ///< where unknown
  cv::Mat confidence;  ///< (H, W) u8, from 1, doubtful, to 255; 0 where unknown
};

/// A way to match images. An object is for one thread at a time and keeps its memory.
class StereoMatcher {
 public:
  StereoMatcher() = default;
  StereoMatcher(const StereoMatcher&) = delete;
  StereoMatcher& operator=(const StereoMatcher&) = delete;
  virtual ~StereoMatcher() = default;

  /// @param left, right  (H, W) or (H, W, 3) u8, intensities or red, green, blue.
  ///
  /// Errors: Invalid (empty, of different sizes, not of u8, a size that the matcher does not take).
  virtual Status match(const cv::Mat& left, const cv::Mat& right, Disparities& found) = 0;
};

/// How images are matched.
struct StereoOptions {
  int disparities = 128;   ///< searched, from 0 on [px]; a multiple of 16, at most 256
  int speckle_size = 100;  ///< smaller patches of disparity are removed [px]
};

/// Semi-global matching of census words along five paths: see semi_global.h. Uses all cores, as
/// cv::setNumThreads() has them; the result does not depend on them. Confidence is how much more
/// the second-best disparity costs.
///
/// Cost: linear in pixels · disparities; doc/sight.md has figures.
std::unique_ptr<StereoMatcher> semi_global_matcher(const StereoOptions& options);

/// Semi-global matching of OpenCV in its three-way mode. Confidence is 255 where a disparity is
/// known. Images must be wider than the disparities searched.
///
/// @param block_size  side of the window that is compared, odd [px].
std::unique_ptr<StereoMatcher> opencv_matcher(const StereoOptions& options, int block_size = 5);

}  // namespace hc::vision
