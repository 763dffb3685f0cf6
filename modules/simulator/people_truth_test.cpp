// SPDX-License-Identifier: Apache-2.0
#include "people_truth.h"

#include <gtest/gtest.h>

#include <numbers>

#include <room/face_shape.h>
#include <room/people.h>
#include <room/scenery.h>

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// An eye at this place that looks straight ahead.
Isometry3d eye_at(double x, double y, double z) {
  return hc::room::hang({x, y, z}, 0);
}

class PersonRow : public testing::Test {
 protected:
  std::vector<hc::room::Person> all = hc::room::People({1, "still", 1}).at(0);
  Vector3d face = all[0].T_world_face.translation();
  hc::graphics::PinholeCamera camera;
};

TEST_F(PersonRow, has_the_face_in_the_world_and_where_the_camera_projects_it) {
  const auto row = row_of(all, 0, eye_at(face.x() - 2, face.y(), face.z() - 0.2), camera);
  EXPECT_EQ(row.person, 1);
  EXPECT_EQ(row.p_world, face);
  EXPECT_NEAR(std::abs(row.yaw), std::numbers::pi - std::abs(std::atan2(face.y(), face.x())), 0.05);
  EXPECT_FALSE(row.speaks);
  EXPECT_NEAR(row.pixel.x(), 399.5, 1e-9);
  EXPECT_NEAR(row.pixel.y(), 299.5 - 60, 1e-9);
  EXPECT_NEAR(row.width, 300 * hc::room::kFaceWidth, 1e-9);
  EXPECT_EQ(row.visible, 1);
}

TEST_F(PersonRow, has_a_part_at_the_border_and_nothing_behind_the_eye) {
  const double border = 2 * 400.0 / 600;
  const auto half = row_of(all, 0, eye_at(face.x() - 2, face.y() - border, face.z()), camera);
  EXPECT_NEAR(half.visible, 0.5, 0.15);
  const auto outside =
      row_of(all, 0, eye_at(face.x() - 2, face.y() - border - 0.2, face.z()), camera);
  EXPECT_EQ(outside.visible, 0);
  EXPECT_GT(outside.width, 30);
  const auto behind = row_of(all, 0, eye_at(face.x() + 1, face.y(), face.z()), camera);
  EXPECT_EQ(behind.pixel, Eigen::Vector2d(0, 0));
  EXPECT_EQ(behind.width, 0);
  EXPECT_EQ(behind.visible, 0);
}

TEST_F(PersonRow, of_a_joint_has_its_numbers_and_place) {
  const auto& hand = all[0].hands[hc::room::kLeft];
  const Vector3d wrist = hand.T_world_wrist.translation();
  const auto eye = eye_at(wrist.x() - 2, wrist.y(), wrist.z());
  const auto row = joint_row(all[0], hc::room::kLeft, 0, eye, camera);
  EXPECT_EQ(row.person, 1);
  EXPECT_EQ(row.side, 0);
  EXPECT_EQ(row.joint, 0);
  EXPECT_LT((row.p_world - wrist).norm(), 1e-6);
  EXPECT_NEAR(row.pixel.x(), 399.5, 1e-3);
  EXPECT_NEAR(row.pixel.y(), 299.5, 1e-3);
  const auto tip = joint_row(all[0], hc::room::kLeft, 12, eye, camera);
  EXPECT_EQ(tip.joint, 12);
  EXPECT_GT(tip.pixel.y(), 299.5 + 40);  // it hangs down
}

}  // namespace
