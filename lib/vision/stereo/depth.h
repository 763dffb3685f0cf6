// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts disparities to depth and points.

#include <opencv2/core.hpp>

namespace hc::vision {

/// The geometry of a rectified pair.
struct StereoGeometry {
  double focal = 0;     ///< focal length of the rectified images [px]
  double baseline = 0;  ///< distance of the two cameras [m]
  double offset = 0;    ///< negated disparity of a point at infinity [px]
  double cx = 0;        ///< principal point of the left camera [px]
  double cy = 0;
};

/// depth = focal · baseline / (disparity + offset), along the optical axis; 0 stays 0, unknown.
///
/// @param disparity  (H, W) f32 [px].
/// @param[out] depth  (H, W) f32 [m].
void depth_of(const cv::Mat& disparity, const StereoGeometry& geometry, cv::Mat& depth);

/// The coloured point of each pixel.
///
/// @param depth  (H, W) f32 [m], 0 where unknown.
/// @param image  (H, W) or (H, W, 3) u8.
/// @param[out] points  (H, W, 6) f32: x right, y down, z ahead [m], in the frame of the left eye,
///     red, green, blue [0, 1]; NaN where the depth is unknown.
void points_of(const cv::Mat& depth, const cv::Mat& image, const StereoGeometry& geometry,
               cv::Mat& points);

}  // namespace hc::vision
