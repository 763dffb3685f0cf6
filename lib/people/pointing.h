// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a hand points to. Pure. Points are in the frame of the left rectified camera, x right, y
// down, z forward [m].

#include <optional>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include <people/hand_place.h>
#include <vision/calibration.h>

namespace hc::people {

/// The ray of a pointing hand.
struct Ray {
  Eigen::Vector3d from;       ///< the tip of the index finger [m]
  Eigen::Vector3d direction;  ///< of length 1
  bool is_from_eye = false;   ///< the eye has aimed by the finger tip; else the finger's direction
};

/// The ray from the eye through the finger tip, as people aim with a stretched arm. Without an eye,
/// or if the finger points elsewhere (kAim), as from the hip: the direction of the finger.
/// @param eye  of the person whose hand it is: the middle between both [m].
Ray pointing_ray(const Joints& joints, const std::optional<Eigen::Vector3d>& eye);
/// Maximum angle between the finger and the line from the eye. [rad]
inline constexpr double kAim = 1.2;

/// How far a ray is followed.
struct Reach {
  double first = 0.25;  ///< from the finger tip: nearer surfaces are those of the hand [m]
  double last = 10;     ///< [m]
  /// A ray that comes out of sight at an edge, by more than this behind it, goes on there [m].
  double thickness = 0.5;
};

/// The place where a ray meets what a depth image shows: where it first gets behind a visible
/// surface. Nothing if it leaves the image, or comes to the camera, before it does.
/// @param depth  (H, W) f32 of the same camera [m], 0 unknown.
/// Cost: linear in the pixels that the ray crosses, a few thousand, or steps of 0.1 mm.
std::optional<Eigen::Vector3d> place_pointed_at(const Ray& ray, const cv::Mat& depth,
                                                const vision::Pinhole& camera,
                                                const Reach& reach = {});

}  // namespace hc::people
