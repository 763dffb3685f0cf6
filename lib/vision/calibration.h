// SPDX-License-Identifier: Apache-2.0
#pragma once
// The calibration of two cameras, and its file. No messages. Different objects may be used from
// different threads.

#include <optional>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace hc::vision {

/// A camera without distortion: projects a point (x, y, z) of its optical frame to the pixel (fx ·
/// x / z + cx, fy · y / z + cy).
struct Pinhole {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
};

/// Two cameras, with OpenCV's names. Frames are optical (x right, y down, z forward).
struct StereoCalibration {
  cv::Size size;                                    ///< of the images [px]; 0 × 0: unknown
  cv::Matx33d M1, M2;                               ///< camera matrices, left and right [px]
  std::vector<double> D1 = std::vector<double>(5);  ///< distortion k1 k2 p1 p2 k3 …: 4, 5, 8,
  std::vector<double> D2 = std::vector<double>(5);  ///< 12 or 14 numbers [1]
  cv::Matx33d R = cv::Matx33d::eye();               ///< p_right = R · p_left + T
  cv::Vec3d T;                                      ///< [m]
  cv::Matx33d R1 = cv::Matx33d::eye(), R2 = R1;     ///< p_rectified = R1 · p_left, R2 · p_right
  cv::Matx34d P1, P2;                               ///< projections of the rectified cameras [px]
  cv::Matx44d Q;   ///< (u, v, disparity, 1) to homogeneous coordinates of the rectified left eye
  double rms = 0;  ///< reprojection error of the calibration views [px]
  double focal_deviation = 0;  ///< standard deviation of the focal lengths, relative; 0: unknown
  std::vector<double> head;  ///< pose of the eyes on a head, in its author's format; empty: unknown

  /// The rectified left camera; the right one differs at most in cx.
  [[nodiscard]] Pinhole rectified() const { return {P1(0, 0), P1(1, 1), P1(0, 2), P1(1, 2)}; }
  /// Distance of the cameras along the rectified x axis [m].
  [[nodiscard]] double baseline() const { return -P2(0, 3) / P2(0, 0); }
  /// Transforms directions from the right camera's frame to the left one's.
  [[nodiscard]] Eigen::Matrix3d R_left_right() const;
};

/// An ideal pair, already rectified: two equal cameras without distortion, side by side.
///
/// @param size  of the images; the optical axis passes through their centre.
/// @param focal  [px]  @param baseline  [m]
StereoCalibration ideal_pair(cv::Size size, double focal, double baseline);

/// Computes R1, R2, P1, P2 and Q from the rest so that the rectified images have no empty borders
/// (OpenCV's stereoRectify, alpha 0). `size` must be known.
void rectify(StereoCalibration& calibration);

/// Sets the rotation of the right camera, keeping its position, and rectifies again if it changed.
/// @param R_left_right  as in StereoCalibration.
void turn(StereoCalibration& calibration, const Eigen::Matrix3d& R_left_right);

enum class Eye { Left, Right };

/// The undistorted ray of a pixel: (x / z, y / z) in the optical frame.
cv::Vec2d ray_of(const StereoCalibration& calibration, Eye eye, cv::Point2d pixel);

/// A calibration as the text of a cv::FileStorage (YAML): image_width, image_height, M1, D1, M2,
/// D2, R, T, R1, R2, P1, P2, Q, rms, and focal_deviation and head if known.
std::string text_of(const StereoCalibration& calibration);

/// Reads the text of text_of(), or the concatenated files intrinsics.yml and extrinsics.yml of
/// OpenCV's sample stereo_calib. image_width, image_height, rms, focal_deviation and head may be
/// missing.
///
/// Errors: Malformed (not YAML of cv::FileStorage; missing keys; wrong shapes; non-finite numbers;
/// invalid rotations or camera matrices; cameras not side by side); TooLarge (64 KiB, 65535 px).
Result<StereoCalibration> calibration_of(const std::string& text);

/// The same with a file, which is replaced atomically. Errors: System (it cannot be opened, read or
/// written), and as above.
Result<StereoCalibration> read_calibration(const std::string& path);
Status write_calibration(const std::string& path, const StereoCalibration& calibration);

/// Whether another program has written a file since it was read.
/// @param before  what was read; nothing: there was no file.
bool has_changed(const std::string& path, const std::optional<StereoCalibration>& before);

}  // namespace hc::vision
