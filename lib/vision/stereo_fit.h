// SPDX-License-Identifier: Apache-2.0
#pragma once
// Calibrates two cameras from views of a chessboard. No messages.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <hc/base/result.h>
#include <vision/board.h>
#include <vision/calibration.h>
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

  /// rms, rms_left, rms_right, epipolar [px], baseline [m], views.
  [[nodiscard]] std::array<double, 6> numbers() const;
  /// "rms 0.214 px (left 0.197, right 0.201), rows differ by …, 12 of 13 views".
  [[nodiscard]] std::string text() const;
};

inline constexpr std::size_t kLeastViews = 3;  ///< needed for a calibration

/// Calibrates two cameras: each alone, then both together. Removes views whose error is more than
/// three times the median, as long as two thirds remain.
///
/// Errors: NotFound (fewer than kLeastViews); Invalid
/// (board); Malformed (views that do not
/// determine the cameras, such as identical ones). Cost: 0.1 to 1 s for 20 views, with
/// the third power of their number.
/// Source: Zhang, A Flexible New Technique for Camera Calibration, 2000 (as in OpenCV).
Result<Calibrated> calibrate(std::span<const BoardView> views, const Board& board, cv::Size size);

}  // namespace hc::vision
