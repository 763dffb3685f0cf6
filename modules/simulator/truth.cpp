// SPDX-License-Identifier: Apache-2.0
#include "truth.h"

#include <algorithm>

#include <frames/messages.h>

#include <room/screen.h>

namespace {

using hc::Coord;

hc::TransformationKind<double> in_world(std::int32_t frame) {
  return hc::transformation().in(hc::transform_coord(Coord::kWorld, frame));
}

template <typename Output>
void send_pose(Output& output, hc::Time time, const Eigen::Isometry3d& pose) {
  if (output.linked()) output.send(hc::numbers_of(pose), time);
}

}  // namespace

std::array<double, 4> seen(const Eigen::Vector3d& ball, const Eigen::Isometry3d& T_world_eye,
                           const hc::graphics::PinholeCamera& camera) {
  const Eigen::Vector3d p_eye = T_world_eye.inverse() * ball;
  if (p_eye.z() <= camera.near) return {0, 0, 0, 0};
  const Eigen::Vector2d pixel = camera.project(p_eye);
  return {pixel.x(), pixel.y(), camera.fx * hc::room::kBallRadius / p_eye.z(),
          camera.contains(pixel) ? hc::room::share_seen(ball, T_world_eye.translation()) : 0};
}

std::array<double, 10> row_of(const hc::room::RoomMarker& marker) {
  const double kind = marker.kind == "aruco" ? 0 : marker.kind == "apriltag" ? 1 : 2;
  const Eigen::Vector3d p = marker.T_world_marker.translation();
  const Eigen::Quaterniond q(marker.T_world_marker.linear());
  return {kind, double(marker.id), marker.side, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

Truth::Truth(hc::Module& module)
    : depth(module.output("depth", hc::intensity_image<float>().in(Coord::kDepth),
                          "truth: depth of the left image [m], 0 for background")),
      head_pose_(module.output("head_pose", in_world(Coord::kHead),
                               "truth: T_world_head as the images were taken")),
      left_pose_(module.output("left_pose", in_world(Coord::kLeftEye), "truth: T_world_left_eye")),
      right_pose_(
          module.output("right_pose", in_world(Coord::kRightEye), "truth: T_world_right_eye")),
      ball_(module.output("ball", hc::position(6).in(Coord::kWorld),
                          "truth: the ball's middle [m] and velocity [m/s]")),
      ball_seen_(module.output("ball_seen", hc::table().of(1, 4),
                               "truth: the ball in the left image, and its visible share",
                               {.columns = {"x [px]", "y [px]", "radius [px]", "visible"}})),
      markers_(module.output("markers", hc::table(),
                             "truth, a row each in the world; kind: 0 aruco, 1 apriltag, 2 colour",
                             {.columns = {"kind", "id", "side [m]", "x [m]", "y [m]", "z [m]", "qx",
                                          "qy", "qz", "qw"}})),
      board_(module.output("board", hc::string(), "truth: text on the board")) {}

void Truth::send_poses(hc::Time time, const Eigen::Isometry3d& T_world_head,
                       const hc::room::Head& head) {
  send_pose(head_pose_, time, T_world_head);
  send_pose(left_pose_, time, T_world_head * head.left_eye);
  send_pose(right_pose_, time, T_world_head * head.right_eye);
}

void Truth::send_ball(hc::Time time, const hc::room::Ball::State& ball, bool is_there,
                      const Eigen::Isometry3d& T_world_left,
                      const hc::graphics::PinholeCamera& camera) {
  if (ball_.linked()) {
    auto draft = ball_.loan(1, 1);
    draft.header.time = time;
    hc::as_eigen<double>(draft) << ball.position.transpose(), ball.velocity.transpose();
    ball_.send(std::move(draft));
  }
  const auto [u, v, radius, share] = seen(ball.position, T_world_left, camera);
  ball_seen_.send({u, v, radius, is_there ? share : 0}, time);
}

void Truth::send_board(hc::Time time, const std::string& text) {
  board_.send(text, time);
}

void Truth::send_markers(hc::Time time, const std::vector<hc::room::RoomMarker>& markers) {
  auto draft = markers_.loan(static_cast<std::int32_t>(markers.size()), 10);
  draft.header.time = time;
  for (std::size_t i = 0; i < markers.size(); ++i)
    std::ranges::copy(row_of(markers[i]), draft.matrix().row(i).begin());
  markers_.send(std::move(draft));
}
