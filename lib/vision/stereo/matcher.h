// SPDX-License-Identifier: Apache-2.0
#pragma once
// Disparities of a rectified stereo pair: a left and a right image whose rows correspond.

#include <memory>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// The result of a matcher for each pixel of the left image. Reuses matrices of that size and type.
struct Disparities {
  cv::Mat disparity;   ///< (H, W) f32 [px], shift to the left of the same point in the right image;
                       ///< 0: unknown
  cv::Mat confidence;  ///< (H, W) u8, from 1, doubtful, to 255; 0 where unknown
  cv::Mat right;       ///< of Eyes::Both, for each pixel of the right image: (H, W) f32 [px], shift
                       ///< to the right of the same point in the left image; 0: unknown
};

/// The eyes whose disparities are found.
enum class Eyes { Left, Both };

/// A stereo matcher. Reuses its memory; not thread-safe.
class StereoMatcher {
 public:
  StereoMatcher() = default;
  StereoMatcher(const StereoMatcher&) = delete;
  StereoMatcher& operator=(const StereoMatcher&) = delete;
  virtual ~StereoMatcher() = default;

  /// @param left, right  (H, W) or (H, W, 3) u8, intensities or red, green, blue.
  ///
  /// Errors: Invalid (empty, of different sizes, not u8, a size that the matcher does not support).
  virtual Status match(const cv::Mat& left, const cv::Mat& right, Disparities& found,
                       Eyes eyes = Eyes::Left) = 0;
};

/// Options of the matchers.
struct StereoOptions {
  int disparities = 128;   ///< searched, from 0 on [px]; a multiple of 16, at most 256
  int speckle_size = 100;  ///< smaller patches of disparity are removed [px]
};

/// Semi-global matching of census words along five paths: see semi_global.h. Uses the number of
/// threads of cv::setNumThreads(), which does not affect the result. Confidence is the cost margin
/// of the second-best disparity. The disparities of both eyes are from the same path costs.
///
/// Cost: linear in pixels · disparities; doc/sight.md has figures.
std::unique_ptr<StereoMatcher> semi_global_matcher(const StereoOptions& options);

/// OpenCV's semi-global matching in three-way mode. Confidence is 255 where a disparity is known.
/// Images must be wider than the disparities searched. Both eyes take twice the time.
///
/// @param block_size  side of the compared window, odd [px].
std::unique_ptr<StereoMatcher> opencv_matcher(const StereoOptions& options, int block_size = 5);

}  // namespace hc::vision
