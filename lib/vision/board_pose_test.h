// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a board is, and where known cameras see its corners, for tests.

#include <vector>

#include <vision/board.h>
#include <vision/calibration.h>
#include <opencv2/calib3d.hpp>

namespace hc::vision {

inline constexpr Board kTestBoard{9, 6, 0.025};

/// The pose of a board whose origin is its first inner corner.
struct BoardPose {
  cv::Matx33d R = cv::Matx33d::eye();
  cv::Vec3d t;  ///< [m]

  /// A board turned about its centre by a rotation vector, with its centre there.
  static BoardPose at(const Board& board, const cv::Vec3d& turn, const cv::Vec3d& centre) {
    BoardPose pose;
    cv::Rodrigues(turn, pose.R);
    const auto corners = board.corners();
    const cv::Scalar middle = cv::mean(corners);
    pose.t = centre - pose.R * cv::Vec3d(middle[0], middle[1], 0);
    return pose;
  }
  /// The same in the frame of another camera.
  [[nodiscard]] BoardPose seen_by_right(const StereoCalibration& pair) const {
    return {pair.R * R, pair.R * t + pair.T};
  }
};

/// Where a camera sees the corners [px].
inline std::vector<cv::Point2f> corners_of(const Board& board, const BoardPose& pose,
                                           const cv::Matx33d& M, const std::vector<double>& D) {
  cv::Vec3d turn;
  cv::Rodrigues(pose.R, turn);
  std::vector<cv::Point2f> corners;
  cv::projectPoints(board.corners(), turn, pose.t, M, D, corners);
  return corners;
}

/// The same by two cameras.
/// @param pose  in the left camera's frame.
inline BoardView view_of(const Board& board, const BoardPose& pose, const StereoCalibration& pair) {
  return {corners_of(board, pose, pair.M1, pair.D1),
          corners_of(board, pose.seen_by_right(pair), pair.M2, pair.D2),
          {}};
}

}  // namespace hc::vision
