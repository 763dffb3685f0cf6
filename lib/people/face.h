// SPDX-License-Identifier: Apache-2.0
#pragma once
// A face in an image. Pure.

#include <array>
#include <cstddef>

#include <opencv2/core/types.hpp>

namespace hc::people {

/// A face. Left and right are the person's own.
struct Face {
  /// In the order of the network's numbers.
  enum Point { RightEye, LeftEye, Nose, Mouth, RightEar, LeftEar };
  static constexpr std::size_t kPoints = LeftEar + 1;

  cv::Rect2f box;                           ///< from the eyebrows to the chin [px]
  float score = 0;                          ///< 0 … 1
  std::array<cv::Point2f, kPoints> points;  ///< [px]

  /// Angle of the line through the eyes, > 0 clockwise in the image, 0 for an upright face.
  /// [rad, -π … π]
  [[nodiscard]] float roll() const;
  [[nodiscard]] cv::Point2f between_eyes() const {
    return (points[RightEye] + points[LeftEye]) / 2;
  }
  /// Estimated from where the nose is between the ears: > 0 when the face looks to the image's
  /// right. Within about 15° up to 60°. [rad]
  [[nodiscard]] float yaw() const;
};

}  // namespace hc::people
