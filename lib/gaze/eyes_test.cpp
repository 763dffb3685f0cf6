// SPDX-License-Identifier: Apache-2.0
#include <gaze/eyes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <gaze/mounted_eyes_test.h>

namespace hc::gaze {
namespace {

/// The pixel at which an eye sees a point of the head frame.
Eigen::Vector2d pixel_of(const Eyes& eyes, Side side, const Eigen::Vector3d& p_head) {
  const Eigen::Vector3d p = eyes.T_head_eye(side).inverse() * p_head;
  return {eyes.cx + eyes.focal * p.x() / p.z(), eyes.cy + eyes.focal * p.y() / p.z()};
}

TEST(Eyes, two_pixels_give_the_place) {
  Eyes crooked = mounted_eyes();
  crooked.calibrate({false, {0.05, -0.03}, {0.01, -0.02, 0.03}, 0.3});
  const Eyes elsewhere(looking_ahead_from({0.02, 0.12, 0.3}), looking_ahead_from({0, -0.1, 0.28}));
  for (const Eyes& eyes : {mounted_eyes(), crooked, elsewhere})
    for (const Eigen::Vector3d& p : {Eigen::Vector3d(2, 0.5, -0.5), Eigen::Vector3d(1, 0, 0.05)}) {
      const auto left = pixel_of(eyes, Side::Left, p), right = pixel_of(eyes, Side::Right, p);
      const auto found = eyes.place_of(left, right);
      ASSERT_TRUE(found);
      EXPECT_NEAR((*found - p).norm(), 0, 1e-9);
      EXPECT_FALSE(eyes.place_of(right, left));  // the rays diverge
      EXPECT_FALSE(eyes.place_of(left, right + Eigen::Vector2d(0, 200)));
    }
}

TEST(Eyes, sit_on_a_bar_that_turns_about_the_axes) {
  Eyes eyes = mounted_eyes();
  eyes.calibrate({false, {M_PI / 2, 0}});  // to the left
  EXPECT_NEAR((eyes.cyclopean().place - Eigen::Vector3d(0, 0.06, 0.05)).norm(), 0, 1e-12);
  EXPECT_NEAR((eyes.cyclopean().direction - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((eyes.place(Side::Left) - Eigen::Vector3d(-0.05, 0.06, 0.05)).norm(), 0, 1e-12);
}

TEST(Eyes, that_are_mounted_aside_stay_so_where_they_look_as_mounted) {
  const Eigen::Isometry3d left =
      Eigen::Translation3d(0.06, 0.05, 0.05) * Eigen::Isometry3d(rotation({0.2, -0.1}).matrix()) *
      Eigen::Isometry3d(optical() * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  Eyes eyes(left, Eigen::Translation3d(0, -0.1, 0) * left);
  eyes.calibrate({false, {0.2, -0.1}});
  EXPECT_TRUE(eyes.T_head_eye(Side::Left).isApprox(left, 1e-12));
  EXPECT_NEAR(eyes.baseline(), 0.1, 1e-12);
}

TEST(Eyes, are_as_far_apart_as_was_measured) {
  Eyes eyes = mounted_eyes();
  eyes.set_baseline(0.13);
  EXPECT_NEAR((eyes.place(Side::Right) - Eigen::Vector3d(0.06, -0.065, 0.05)).norm(), 0, 1e-12);
  EXPECT_NEAR(eyes.baseline(), 0.13, 1e-12);
}

TEST(HeadCalibration, is_its_numbers) {
  const HeadCalibration written{true, {0.01, -0.02}, {0.03, 0.04, -0.05}, 0.25};
  const auto read = HeadCalibration::of(written.numbers());
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->swapped);
  EXPECT_EQ(read->zero.pan, 0.01);
  EXPECT_EQ(read->zero.tilt, -0.02);
  EXPECT_EQ(read->offset, written.offset);
  EXPECT_EQ(read->rms, 0.25);
}

TEST(HeadCalibration, what_is_none_is_refused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& numbers : {std::vector<double>{},
                                             {0, 0, 0, 0, 0, 0},
                                             {0.5, 0, 0, 0, 0, 0, 0},
                                             {0, nan, 0, 0, 0, 0, 0},
                                             {0, 0, 0, 0, 0, 1.5, 0},
                                             {0, 0, 0, 0, 0, 0, nan}})
    EXPECT_FALSE(HeadCalibration::of(numbers)) << numbers.size();
}

}  // namespace
}  // namespace hc::gaze
