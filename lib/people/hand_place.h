// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a hand is in space. Pure. Points are in the frame of the left rectified camera, x right, y
// down, z forward [m].

#include <array>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <people/hand.h>
#include <vision/calibration.h>

namespace hc::people {

/// The points of a hand, in the order of Hand::points.
using Joints = std::array<Eigen::Vector3d, Hand::kPoints>;

/// The joints of a hand of ordinary size, whose image is that of the points; nothing if no such
/// hand is before the camera.
std::optional<Joints> joints_of(const Hand& hand, const vision::Pinhole& camera);

/// The same hand, larger or smaller, with the middle of its palm at another depth: each joint stays
/// at its pixel.
Joints moved_to(Joints joints, double depth);
/// The depth of the middle of the palm. [m]
double depth_of(const Joints& joints);

/// The depth of the palm in a depth image; nothing if it is unknown in most places.
/// @param depth  (H, W) f32 of the same camera [m], 0 unknown.
std::optional<double> depth_in(const cv::Mat& depth, const Hand& hand);

/// The joints of a hand that both rectified eyes see, each triangulated; nothing if the points do
/// not fit one hand.
/// @param baseline  [m]
std::optional<Joints> joints_by_eyes(const Hand& left, const Hand& right,
                                     const vision::Pinhole& camera, double baseline);

/// Where to look for a hand of the left image in that of the right eye.
/// @param disparity  [px]
Region region_in_right(const Hand& left, double disparity);

}  // namespace hc::people
