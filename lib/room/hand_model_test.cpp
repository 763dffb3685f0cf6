// SPDX-License-Identifier: Apache-2.0
#include <room/hand_model.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hc::room {

namespace {

using Eigen::Vector3d;

constexpr int kMiddleRoot = 9, kMiddleTip = 12, kThumbTip = 4, kLittleTip = 20;

const std::array<Vector3d, kHandJoints>& joints(Sign sign, int side = kRight) {
  return hand_joints(side, sign);
}

TEST(HandModel, has_the_fingers_along_minus_z_the_thumb_inside_and_the_wrist_at_the_origin) {
  for (const int side : {kLeft, kRight}) {
    const auto& open = joints(Sign::Open, side);
    EXPECT_LT(open[0].norm(), 1e-6);
    EXPECT_NEAR(open[kMiddleTip].z(), -0.18, 0.02);
    // With the palm down, a right hand's thumb is on its left.
    EXPECT_GT(side_sign(side) * (open[kThumbTip].x() - open[kLittleTip].x()), 0.08);
  }
}

TEST(HandModel, keeps_the_bones_lengths_in_every_sign) {
  for (int sign = 0; sign < kSigns; ++sign)
    for (int joint = 1; joint < kHandJoints; ++joint) {
      if (joint % 4 == 1) continue;  // roots of fingers
      const auto i = static_cast<std::size_t>(joint);
      auto length = [&](Sign of) { return (joints(of)[i] - joints(of)[i - 1]).norm(); };
      EXPECT_NEAR(length(static_cast<Sign>(sign)), length(Sign::Open), 1e-5)
          << sign << " " << joint;
    }
}

TEST(HandModel, bends_and_stretches_the_fingers_of_each_sign) {
  auto reach = [](Sign sign, int finger) {
    const auto& all = joints(sign);
    const auto root = static_cast<std::size_t>(1 + 4 * finger);
    return (all[root + 3] - all[root]).norm();
  };
  for (int finger = 1; finger <= 4; ++finger) {
    EXPECT_GT(reach(Sign::Open, finger), 0.06);
    EXPECT_LT(reach(Sign::Fist, finger), 0.048);
    EXPECT_LT(reach(Sign::Thumb, finger), 0.048);
    EXPECT_EQ(reach(Sign::Point, finger) > 0.06, finger == 1);
    EXPECT_EQ(reach(Sign::Victory, finger) > 0.06, finger <= 2);
  }
  // Towards the palm, which is down.
  EXPECT_LT(joints(Sign::Fist)[kMiddleTip].y(), joints(Sign::Fist)[kMiddleRoot].y());
  const Vector3d thumb = joints(Sign::Thumb)[kThumbTip] - joints(Sign::Thumb)[1];
  EXPECT_LT(thumb.normalized().x(), -0.6);
}

TEST(HandModel, has_its_surface_around_its_joints) {
  for (const int side : {kLeft, kRight})
    for (int sign = 0; sign < kSigns; ++sign) {
      const auto& all = joints(static_cast<Sign>(sign), side);
      const auto& mesh = hand_mesh(side, static_cast<Sign>(sign));
      for (const int tip : {4, 8, 12, 16, 20}) {
        double nearest = 1;
        for (const auto& vertex : mesh.vertices)
          nearest = std::min(
              nearest,
              (vertex.position.cast<double>() - all[static_cast<std::size_t>(tip)]).norm());
        EXPECT_LT(nearest, 0.012) << sign << " " << tip;
      }
      for (const auto& vertex : mesh.vertices) {
        double nearest = 1;
        for (const auto& joint : all)
          nearest = std::min(nearest, (vertex.position.cast<double>() - joint).norm());
        EXPECT_LT(nearest, 0.06);
        EXPECT_NEAR(vertex.normal.norm(), 1, 1e-4);
      }
    }
}

TEST(HandModel, is_alike_on_both_sides) {
  for (int sign = 0; sign < kSigns; ++sign)
    for (std::size_t i = 0; i < kHandJoints; ++i) {
      Vector3d mirrored = joints(static_cast<Sign>(sign), kLeft)[i];
      mirrored.x() *= -1;
      EXPECT_LT((mirrored - joints(static_cast<Sign>(sign))[i]).norm(), 0.02) << sign << " " << i;
    }
}

}  // namespace

}  // namespace hc::room
