// SPDX-License-Identifier: Apache-2.0
#pragma once
// How well views of a board determine the calibration of two cameras. Pure.

#include <limits>
#include <vector>

#include <hc/base/result.h>
#include <vision/calibration.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// How well views determine a calibration: standard deviations of what is computed with it.
struct Deviations {
  double focal = std::numeric_limits<double>::infinity();  ///< of the focal lengths, relative
  double baseline = focal;  ///< of the distance of the cameras, relative
  /// Where a far point of the left image is expected in the right one, the largest of 25 points
  /// over the middle two thirds of the image [px].
  double match = focal;

  /// Errors: NotFound (one of them is too large; the detail says which).
  [[nodiscard]] Status check() const;
};

/// The deviations of a calibration that is the best fit to views, with its residual, `rms`.
///
/// The errors of all corners are taken for independent, and small enough for a linear
/// approximation. Infinite where the views leave a number free.
/// @param board  the corners of each view on the board [m].
/// @param left  their places in the left image [px].
Deviations deviations_of(const StereoCalibration& calibration,
                         const std::vector<std::vector<cv::Point3f>>& board,
                         const std::vector<std::vector<cv::Point2f>>& left);

}  // namespace hc::vision
