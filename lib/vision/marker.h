// SPDX-License-Identifier: Apache-2.0
#pragma once
// Square markers: what they have in common, and where they are. No messages.

#include <array>
#include <optional>
#include <vector>

#include <vision/calibration.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// Of a table of markers as a message, which `marker` describes.
inline constexpr int kMarkerColumns = 12;

enum class MarkerKind { Aruco = 0, AprilTag = 1, Colour = 2 };

/// A marker in an image.
struct Marker {
  MarkerKind kind = MarkerKind::Aruco;
  int id = 0;  ///< of the dictionary or family; of a coloured one, its hue, 0 … 359 [degree]
  /// Top left, top right, bottom right, bottom left as the marker is read [px], (0, 0) being the
  /// middle of the top left pixel.
  std::array<cv::Point2d, 4> corners;

  [[nodiscard]] double mean_side() const;    ///< [px]
  [[nodiscard]] cv::Point2d middle() const;  ///< mean of the corners [px]
};

/// A camera as images come out of it.
struct Camera {
  Pinhole pinhole;
  std::vector<double> distortion;  ///< as StereoCalibration::D1; empty: none
};

/// A camera, and the turn from its images' axes to those of its eye.
struct EyeCamera {
  Camera camera;
  cv::Matx33d R_eye_camera = cv::Matx33d::eye();
};

/// An eye's camera, or the one that its rectified images seem to be of.
EyeCamera camera_of(const StereoCalibration& pair, Eye eye, bool is_rectified);

/// Where a marker is. Its frame: x right, y down, z into the marker as seen by who looks at it,
/// origin in its middle.
struct MarkerPose {
  cv::Matx33d R = cv::Matx33d::eye();  ///< of T_eye_marker
  cv::Vec3d t;                         ///< [m]
  double error = 0;                    ///< reprojection error, root of the mean square [px]
};

/// The pose that explains a marker's corners best.
///
/// @param side  of the marker [m].
/// @returns  nothing for corners that no square before the camera has.
/// Source: Collins and Bartoli, Infinitesimal Plane-Based Pose Estimation, 2014; then
/// Levenberg-Marquardt on the reprojection error.
std::optional<MarkerPose> pose_of(const Marker& marker, double side, const Camera& camera);

/// Moves corners to where lines through the edges of the marker's sides meet.
///
/// @param grey  (H, W) u8, in which the marker's rim differs from what is about it.
/// @param reach  how far an edge may be from where it is looked for [px], 1.5 at least.
/// @returns  whether all four edges were found; the corners stay as they are otherwise.
/// Cost: 20 µs.
bool refine_corners(const cv::Mat& grey, std::array<cv::Point2d, 4>& corners, double reach = 2.5);

}  // namespace hc::vision
