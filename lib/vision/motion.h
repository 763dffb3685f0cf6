// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a camera has turned and moved between two images of a scene at rest. No messages.

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace hc::vision {

/// Intrinsics of a camera without distortion [px].
struct Intrinsics {
  double focal = 600, cx = 399.5, cy = 299.5;
};

/// Points of a scene in two images, place by place. [px]
struct Matches {
  std::vector<cv::Point2f> a, b;
};

/// A camera's movement: takes points in its optical frame at b to that at a, up to the length of t.
struct RelativePose {
  Eigen::Matrix3d R_a_b = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();  ///< direction of b's place in a, of length 1
  std::size_t inliers = 0;                      ///< matches that agree
  double rms = 0;                               ///< of their distances from the epipolar lines [px]
};

/// Finds points of image a in image b.
///
/// @param a, b  (H, W) u8 of the same size.
/// @param R_a_b  about how the camera has turned, within some degrees.
/// Cost: 30 ms for 800 × 600.
Matches match(const cv::Mat& a, const cv::Mat& b, const Intrinsics& camera,
              const Eigen::Matrix3d& R_a_b);

/// The movement that agrees best with matches: Sampson's error, outliers removed.
///
/// @param R_a_b, t  where to begin; t of any length but 0.
/// @param is_known  the direction of t is known, and R alone is found: better where the camera
///     turns much and moves little.
/// @returns  nothing if fewer than 30 matches agree to 1 px.
/// Source: Hartley, Zisserman, Multiple View Geometry, 2nd edition, 11.4.3.
std::optional<RelativePose> relative_pose(const Matches& matches, const Intrinsics& camera,
                                          const Eigen::Matrix3d& R_a_b, const Eigen::Vector3d& t,
                                          bool is_known = false);

}  // namespace hc::vision
