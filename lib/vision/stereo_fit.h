// SPDX-License-Identifier: Apache-2.0
#pragma once
// Calibrates two cameras from views of a board, and judges how well the views determine them.
// No messages.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <hc/base/result.h>
#include <vision/board.h>
#include <vision/calibration.h>
#include <vision/deviations.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// A calibration and its quality.
struct Calibrated {
  StereoCalibration calibration;
  std::size_t views = 0;  ///< used
  double rms_all = 0;     ///< reprojection error before outliers were removed [px]
  double rms_left = 0;    ///< reprojection error of the left camera alone [px]
  double rms_right = 0;   ///< [px]
  double epipolar = 0;    ///< mean distance of corresponding rows, rectified [px]
  std::size_t given = 0;  ///< views given
  Deviations deviations;

  /// rms, rms_left, rms_right, epipolar [px], baseline [m], views, deviations: focal, baseline [1],
  /// match [px].
  [[nodiscard]] std::array<double, 9> numbers() const;
  /// "rms 0.214 px (left 0.197, right 0.201), rows differ by …, 12 of 13 views".
  [[nodiscard]] std::string text() const;
};

inline constexpr std::size_t kLeastViews = 3;  ///< needed for a calibration

/// Calibrates two cameras: each alone, then both together. Removes views whose error is more than
/// three times the median, as long as two thirds remain.
///
/// The residual says nothing about numbers on which the images hardly depend, such as the focal
/// lengths while the board faces the cameras; so the covariance of the fit is computed as well, and
/// a fit that Deviations::check() refuses is an error.
///
/// Errors: NotFound (fewer than kLeastViews; views that do not determine the cameras); Invalid
/// (board); Malformed (views that no pair of cameras has). Cost: 0.1 to 1 s for 20 views, with
/// the third power of their number.
/// Source: Zhang, A Flexible New Technique for Camera Calibration, 2000 (as in OpenCV).
Result<Calibrated> calibrate(std::span<const BoardView> views, const Board& board, cv::Size size);

/// The root mean square distance of corners from where a calibration expects them, each view's pose
/// being the one that its left image shows [px]; infinite if some view is impossible.
double error_of(const StereoCalibration& calibration, std::span<const BoardView> views,
                const Board& board);

}  // namespace hc::vision
