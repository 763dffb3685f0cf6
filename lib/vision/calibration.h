// SPDX-License-Identifier: Apache-2.0
#pragma once
// The geometry of two cameras: how it is found from views of a chessboard, and the file it is kept
// in. No messages; plain cv::Mat in and out. Different objects may be used from different threads.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace hc::vision {

/// A camera without distortion: a point (x, y, z) of its optical frame is seen at the pixel
/// (fx · x / z + cx, fy · y / z + cy).
struct Pinhole {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< [px]
};

/// Two cameras, by OpenCV's names. Frames are optical (x right, y down, z forward).
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
  double rms = 0;  ///< reprojection error of what it was found from [px]
  std::vector<double> head;  ///< how the eyes sit on a head, by who found that; empty: unknown

  /// The rectified cameras; both have the same numbers but for cx.
  [[nodiscard]] Pinhole rectified() const { return {P1(0, 0), P1(1, 1), P1(0, 2), P1(1, 2)}; }
  /// Distance of the cameras along the rectified x axis [m].
  [[nodiscard]] double baseline() const { return -P2(0, 3) / P2(0, 0); }
  /// Takes directions as the right camera has them to the left one's.
  [[nodiscard]] Eigen::Matrix3d R_left_right() const;
};

/// A pair that is rectified as it is: two equal cameras without distortion, side by side.
///
/// @param size  of the images; the optical axis goes through their middle.
/// @param focal  [px]  @param baseline  [m]
StereoCalibration ideal_pair(cv::Size size, double focal, double baseline);

/// Sets R1, R2, P1, P2 and Q from the rest so that all of the rectified images is seen by the
/// cameras (OpenCV's stereoRectify, alpha 0). `size` must be known.
void rectify(StereoCalibration& calibration);

/// Turns the right camera about its own middle, and rectifies again if that is not how it is.
/// @param R_left_right  as in StereoCalibration.
void turn(StereoCalibration& calibration, const Eigen::Matrix3d& R_left_right);

enum class Eye { Left, Right };

/// Where a pixel is seen along, without the lens's distortion: (x / z, y / z) in the optical frame.
cv::Vec2d ray_of(const StereoCalibration& calibration, Eye eye, cv::Point2d pixel);

/// What a calibration is, as a file of cv::FileStorage (YAML): image_width, image_height, M1, D1,
/// M2, D2, R, T, R1, R2, P1, P2, Q, rms, and head if it is known.
std::string text_of(const StereoCalibration& calibration);

/// Reads what text_of() wrote, or the files intrinsics.yml and extrinsics.yml that OpenCV's sample
/// stereo_calib writes, one behind the other. image_width, image_height, rms and head may be
/// missing.
///
/// Errors: Malformed (no YAML of cv::FileStorage; a key that is missing; another shape; a number
/// that is not finite; what is no rotation or no camera; cameras that are not side by side);
/// TooLarge (64 KiB, 65535 px).
Result<StereoCalibration> calibration_of(const std::string& text);

/// The same with a file. Errors: System (not to be opened, read, written), as above. The file is
/// replaced as a whole: a reader sees the old or the new one.
Result<StereoCalibration> read_calibration(const std::string& path);
Status write_calibration(const std::string& path, const StereoCalibration& calibration);

/// A chessboard by its inner corners, of which there are not as many in a row as in a column.
struct Board {
  int columns = 9, rows = 6;  ///< inner corners in a row, in a column
  double square = 0.025;      ///< side of a square [m]
};

/// A board's corners in both images, row by row [px]; the same corner has the same place in both.
struct BoardView {
  std::vector<cv::Point2f> left, right;
};

/// Finds the board in both images.
///
/// @param left, right  (H, W) or (H, W, 3) u8, red, green, blue.
/// Cost: a few ms at 640×480 where the board is, 20 ms and more where it is not.
std::optional<BoardView> find_board(const cv::Mat& left, const cv::Mat& right, const Board& board);

/// How far two views are from one another: the mean distance of their corners [px].
double difference(const BoardView& a, const BoardView& b);

/// A calibration, and how good it is.
struct Calibrated {
  StereoCalibration calibration;
  std::size_t views = 0;  ///< that were used
  double rms_all = 0;     ///< reprojection error before outliers were removed [px]
  double rms_left = 0;    ///< reprojection error of the left camera alone [px]
  double rms_right = 0;   ///< [px]
  double epipolar = 0;    ///< mean distance of corresponding rows, rectified [px]
  std::size_t given = 0;  ///< views it was given

  /// rms, that of the left and of the right camera, epipolar [px], baseline [m], views.
  [[nodiscard]] std::array<double, 6> numbers() const;
  /// "rms 0.214 px (left 0.197, right 0.201), rows differ by …, 12 of 13 views".
  [[nodiscard]] std::string text() const;
};

inline constexpr std::size_t kLeastViews = 3;  ///< that a calibration takes

/// Finds the geometry of two cameras: each alone, then both together. Views whose error is more
/// than three times the median's are removed, as long as two thirds remain.
///
/// Errors: NotFound (fewer than kLeastViews); Invalid (a board that is not so); Malformed (views
/// that do not determine the cameras, as when all are the same). Cost: 0.1 to 1 s. Source: Zhang, A
/// Flexible New Technique for Camera Calibration, 2000 (as in OpenCV).
Result<Calibrated> calibrate(std::span<const BoardView> views, const Board& board, cv::Size size);

}  // namespace hc::vision
