// SPDX-License-Identifier: Apache-2.0
#include <gaze/aim.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hc::gaze {
namespace {

TEST(Aim, pan_turns_left_and_tilt_down) {
  EXPECT_GT((rotation({0.3, 0}) * Eigen::Vector3d::UnitX()).y(), 0);
  EXPECT_LT((rotation({0, 0.3}) * Eigen::Vector3d::UnitX()).z(), 0);
  for (const Angles& angles : {Angles{0.7, -0.4}, Angles{-2.5, 0.8}, Angles{0, 0}}) {
    const auto back = angles_of(rotation(angles));
    EXPECT_NEAR(back.pan, angles.pan, 1e-12);
    EXPECT_NEAR(back.tilt, angles.tilt, 1e-12);
  }
  EXPECT_NEAR(between({0.1, 0}, {0.3, 0}), 0.2, 1e-12);
  EXPECT_NEAR(between({1, 0.1}, {1, -0.1}), 0.2, 1e-12);
}

TEST(Aim, the_eye_looks_at_the_place) {
  const Sight built{{0.06, 0.01, 0.05}, Eigen::Vector3d::UnitX()};
  const Sight squints{{0.05, -0.02, 0.04}, Eigen::Vector3d(1, 0.1, -0.06).normalized()};
  for (const Sight& eye : {built, squints})
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(2, 0.5, -0.5), Eigen::Vector3d(0.4, -0.6, 0.2),
                                     Eigen::Vector3d(-1, 1, 0.3)}) {
      const auto angles = aim(p, eye);
      const Eigen::Vector3d seen = rotation(angles).inverse() * p - eye.place;
      EXPECT_NEAR(seen.cross(eye.direction).norm(), 0, 1e-9);
      EXPECT_GT(seen.dot(eye.direction), 0);
      EXPECT_LT(std::abs(angles.tilt), 1.5);
    }
}

TEST(Aim, what_cannot_be_looked_at_gives_numbers_all_the_same) {
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0.05)}) {
    const Sight eye{{0.06, 0, 0.05}, Eigen::Vector3d::UnitX()};
    EXPECT_TRUE(std::isfinite(aim(p, eye).pan));
    EXPECT_TRUE(std::isfinite(aim(p, eye).tilt));
  }
}

}  // namespace
}  // namespace hc::gaze
