// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images of two cameras as two ideal cameras side by side would have taken them. No messages.

#include <hc/base/result.h>
#include <vision/calibration.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// Rectifies the images of one eye; where each pixel comes from is found once.
class Rectifier {
 public:
  /// @param size  of the images, and of the rectified ones [px].
  ///
  /// Errors: Unsupported (the calibration is for another size); TooLarge (no pixels, or a
  /// side of more than 32766).
  /// Cost: 10 ms at 800×600.
  static Result<Rectifier> make(const StereoCalibration& calibration, Eye eye, cv::Size size);

  /// @param image  (H, W) or (H, W, 3) u8, of the size it was made for.
  /// @param[out] rectified  the same shape, written in place when it has it already; black where
  ///     the camera saw nothing.
  /// Cost: 2 ms at 800×600 in colour; a copy where nothing is to be done.
  void rectify(const cv::Mat& image, cv::Mat& rectified) const;

  [[nodiscard]] cv::Size size() const { return size_; }

 private:
  cv::Size size_;
  cv::Mat whole_, part_;  // CV_16SC2 whole pixels and CV_16UC1 parts; empty: images stay as is
};

}  // namespace hc::vision
