// SPDX-License-Identifier: Apache-2.0
#pragma once
// Square markers and their poses, common to all kinds. No messages.

#include <array>
#include <optional>
#include <vector>

#include <vision/calibration.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// Columns of the table of markers in a message; see the module `marker`.
inline constexpr int kMarkerColumns = 13;

enum class MarkerKind { Aruco = 0, AprilTag = 1, Colour = 2 };

/// A marker in an image.
struct Marker {
  MarkerKind kind = MarkerKind::Aruco;
  int id = 0;  ///< in the dictionary or family; for a coloured one, the hue, 0 … 359 [degree]
  /// Top left, top right, bottom right, bottom left of the upright marker [px]; (0, 0) is the
  /// centre of the top left pixel.
  std::array<cv::Point2d, 4> corners;

  [[nodiscard]] double mean_side() const;    ///< [px]
  [[nodiscard]] cv::Point2d middle() const;  ///< mean of the corners [px]
};

/// A camera with its lens distortion.
struct Camera {
  Pinhole pinhole;
  std::vector<double> distortion;  ///< as StereoCalibration::D1; empty: none
};

/// A camera, and the rotation from its frame to that of its eye.
struct EyeCamera {
  Camera camera;
  cv::Matx33d R_eye_camera = cv::Matx33d::eye();
};

/// The camera of an eye, or the virtual one of its rectified images.
EyeCamera camera_of(const StereoCalibration& pair, Eye eye, bool is_rectified);

/// The pose of a marker. Its frame as seen from the front: x right, y down, z into the marker,
/// origin at its centre.
struct MarkerPose {
  cv::Matx33d R = cv::Matx33d::eye();  ///< of T_eye_marker
  cv::Vec3d t;                         ///< [m]
  double error = 0;                    ///< reprojection error, RMS [px]
  /// Four corners may fit two rotations: the angle to the other one, if it fits about as well; else
  /// 0. [rad]
  double ambiguity = 0;
};

/// The pose with the least reprojection error of a marker's corners.
///
/// @param side  of the marker [m].
/// @returns  nothing if no square in front of the camera has such corners.
/// Source: Collins and Bartoli, Infinitesimal Plane-Based Pose Estimation, 2014; then
/// Levenberg-Marquardt on the reprojection error.
std::optional<MarkerPose> pose_of(const Marker& marker, double side, const Camera& camera);

/// Moves corners to the intersections of lines fitted to the edges of the marker.
///
/// @param grey  (H, W) u8, in which the marker's rim contrasts with its surroundings.
/// @param reach  maximum distance of an edge from its expected position [px], at least 1.5.
/// @returns  whether all four edges were found; otherwise the corners are unchanged.
/// Cost: 20 µs.
bool refine_corners(const cv::Mat& grey, std::array<cv::Point2d, 4>& corners, double reach = 2.5);

}  // namespace hc::vision
