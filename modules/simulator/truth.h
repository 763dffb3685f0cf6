// SPDX-License-Identifier: Apache-2.0
#pragma once
// The outputs with ground truth, for scoring.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/camera.h>
#include <hc/module/module.h>

#include <room/ball.h>
#include <room/head.h>
#include <room/markers.h>

/// The ball in an image: u, v, radius [px], visible share (0 … 1; 0 outside the image).
///
/// @param ball  its centre in the world [m].
std::array<double, 4> seen(const Eigen::Vector3d& ball, const Eigen::Isometry3d& T_world_eye,
                           const hc::graphics::PinholeCamera& camera);

/// A marker as a row: kind (0 aruco, 1 apriltag, 2 colour), id, side [m], x y z [m] and
/// qx qy qz qw of T_world_marker.
std::array<double, 10> row_of(const hc::room::RoomMarker& marker);

class Truth {
 public:
  explicit Truth(hc::Module& module);

  hc::Output<decltype(hc::intensity_image<float>())> depth;

  void send_poses(hc::Time time, const Eigen::Isometry3d& T_world_head, const hc::room::Head& head);
  /// @param is_there  if false, the visible share is 0.
  void send_ball(hc::Time time, const hc::room::Ball::State& ball, bool is_there,
                 const Eigen::Isometry3d& T_world_left, const hc::graphics::PinholeCamera& camera);
  void send_board(hc::Time time, const std::string& text);
  void send_markers(hc::Time time, const std::vector<hc::room::RoomMarker>& markers);

 private:
  using Poses = hc::Output<decltype(hc::transformation())>;
  using Tables = hc::Output<decltype(hc::table())>;

  Poses head_pose_, left_pose_, right_pose_;
  hc::Output<decltype(hc::position(6))> ball_;
  Tables ball_seen_, markers_;
  hc::Output<decltype(hc::string())> board_;
};
