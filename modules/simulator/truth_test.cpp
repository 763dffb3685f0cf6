// SPDX-License-Identifier: Apache-2.0
#include "truth.h"

#include <gtest/gtest.h>

#include <numbers>

#include <room/head.h>

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// An eye at the head's origin, at the height of the ball, that looks along x, turned to the left.
Isometry3d eye(double pan) {
  return hc::room::head_pose(pan, 0) * hc::room::hang({0, 0, 0}, 0);
}

TEST(SeenBall, is_where_the_camera_projects_it) {
  const auto [u, v, radius, share] = seen({2, 0.2, 1.1}, eye(0), {});
  EXPECT_NEAR(u, 399.5 - 600 * 0.1, 1e-9);
  EXPECT_NEAR(v, 299.5 + 600 * 0.05, 1e-9);
  EXPECT_NEAR(radius, 600 * hc::room::kBallRadius / 2, 1e-9);
  EXPECT_EQ(share, 1);
}

TEST(SeenBall, has_no_share_outside_the_image) {
  const double edge = std::atan(400.0 / 600);
  EXPECT_EQ(seen({2, 0, 1.2}, eye(edge - 0.01), {})[3], 1);
  EXPECT_EQ(seen({2, 0, 1.2}, eye(edge + 0.01), {})[3], 0);
  EXPECT_GT(seen({2, 0, 1.2}, eye(edge + 0.01), {})[2], 0);
}

TEST(SeenBall, is_nowhere_behind_the_eye) {
  EXPECT_EQ(seen({-2, 0, 1.2}, eye(0), {}), (std::array<double, 4>{}));
}

TEST(PlateRow, has_kind_number_side_and_pose) {
  hc::room::RoomMarker marker{"apriltag", 7, 0.16, Isometry3d(Eigen::Translation3d(1, 2, 3))};
  EXPECT_EQ(row_of(marker), (std::array<double, 10>{1, 7, 0.16, 1, 2, 3, 0, 0, 0, 1}));
  marker.kind = "aruco";
  EXPECT_EQ(row_of(marker)[0], 0);
  marker.kind = "colour";
  marker.T_world_marker.rotate(Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()));
  const auto row = row_of(marker);
  EXPECT_EQ(row[0], 2);
  EXPECT_NEAR(row[8], std::sqrt(0.5), 1e-12);  // qz
  EXPECT_NEAR(row[9], std::sqrt(0.5), 1e-12);  // qw
}

}  // namespace
