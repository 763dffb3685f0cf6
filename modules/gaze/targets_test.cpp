// SPDX-License-Identifier: Apache-2.0
#include "targets.h"

#include <gtest/gtest.h>

#include <gaze/mounted_eyes_test.h>

namespace {

constexpr hc::Time kNow{std::chrono::seconds(1'700'000'000)};

Targets targets() {
  return {hc::gaze::mounted_eyes(), {}, 2.5};
}

/// The rotation of the head.
Eigen::Isometry3d pan(double angle) {
  return Eigen::Isometry3d(hc::gaze::rotation({angle, 0}));
}

hc::gaze::Angles last(const Targets& targets) {
  const auto& follower = targets.follower();
  return follower.last() ? follower.at(*follower.last())->angles : hc::gaze::Angles{9, 9};
}

TEST(Targets, a_place_is_looked_at_by_how_the_head_was_turned) {
  auto one = targets();
  const Eigen::Vector3d p(2, 0, 0.05);
  one.see(kNow, kHead, p, pan(0.2));
  EXPECT_NEAR(last(one).pan, 0.2, 1e-6);
  auto other = targets();
  other.see(kNow, kRobot, pan(0.3) * p, pan(0));
  EXPECT_NEAR(last(other).pan, 0.3, 1e-6);
}

TEST(Targets, a_place_in_an_eye_is_where_the_eye_sees_it) {
  for (bool swapped : {false, true}) {
    auto one = targets();
    one.calibrate(hc::gaze::HeadCalibration{swapped, {0.1, 0}, Eigen::Vector3d::Zero(), 0});
    one.see(kNow, swapped ? kRightEye : kLeftEye, {0.05, 0, 2}, pan(0.2));  // before the middle
    EXPECT_NEAR(last(one).pan, 0.2, 1e-6) << swapped;
  }
}

TEST(Targets, are_looked_at_with_eyes_that_sit_as_they_were_found) {
  auto crooked = targets();
  crooked.calibrate(hc::gaze::HeadCalibration{false, {0.1, 0}, Eigen::Vector3d::Zero(), 0});
  crooked.see(kNow, kRobot, pan(0.3) * Eigen::Vector3d(2, 0, 0), pan(0));
  EXPECT_NEAR(last(crooked).pan, 0.2, 1e-3);
}

TEST(Targets, are_seen_by_eyes_that_are_swapped) {
  const double side = 600 * 0.05 / 2;  // of a point 2 m in front of the centre of the eyes [px]
  for (bool swapped : {false, true}) {
    auto eyes = targets();
    eyes.calibrate(hc::gaze::HeadCalibration{swapped, {}, Eigen::Vector3d::Zero(), 0});
    for (int i = 0; i < 40; ++i) {
      const hc::Time time = kNow + i * std::chrono::milliseconds(50);
      eyes.see(time, swapped ? kRightImage : kLeftImage, {399.5 + side, 299.5, 0}, pan(0));
      eyes.see(time, swapped ? kLeftImage : kRightImage, {399.5 - side, 299.5, 0}, pan(0));
    }
    EXPECT_NEAR(last(eyes).pan, 0, 1e-3) << swapped;
  }
}

TEST(Targets, pixels_are_without_the_lens_where_it_was_measured) {
  auto cameras = hc::vision::ideal_pair({800, 600}, 500, 0.2);
  cameras.D1 = {-0.2, 0, 0, 0, 0};
  auto measured = targets();
  ASSERT_TRUE(measured.calibrate(cameras));
  measured.see(kNow, kLeftImage, {100, 299.5, 0}, pan(0));
  auto ideal = targets();
  ideal.see(kNow, kLeftImage, {100, 299.5, 0}, pan(0));
  EXPECT_GT(last(measured).pan, last(ideal).pan + 0.05);
  cameras.head = {1, 2};
  EXPECT_FALSE(measured.calibrate(cameras));
}

TEST(Targets, what_an_eye_sees_is_seen_in_the_head) {
  for (int coord : {kLeftEye, kRightEye, kLeftImage, kRightImage})
    EXPECT_EQ(Targets::frame_of(coord), kHead);
  for (int coord : {1, 2, 3, 101}) EXPECT_EQ(Targets::frame_of(coord), coord);
}

}  // namespace
