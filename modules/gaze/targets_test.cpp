// SPDX-License-Identifier: Apache-2.0
#include "targets.h"

#include <gtest/gtest.h>

namespace {

constexpr std::int64_t kNow = 1'700'000'000'000'000'000, kMillisecond = 1'000'000;

Targets targets() {
  return {{}, {}, 2.5};
}

hc::gaze::Angles last(const Targets& targets) {
  const auto& follower = targets.follower();
  return follower.last() ? follower.at(*follower.last())->angles : hc::gaze::Angles{9, 9};
}

TEST(Targets, a_place_is_looked_at_by_how_the_head_stood) {
  auto one = targets();
  const Eigen::Vector3d p(2, 0, 0.05);
  one.report(kNow, hc::gaze::rotation({0, 0}));
  one.report(kNow + 20 * kMillisecond, hc::gaze::rotation({0.4, 0}));
  one.see(kNow + 10 * kMillisecond, kHead, p);
  one.take_in(kNow + 30 * kMillisecond);
  EXPECT_NEAR(last(one).pan, 0.2, 1e-6);
  auto other = targets();
  other.see(kNow, kRobot, Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * p);
  other.take_in(kNow);
  EXPECT_NEAR(last(other).pan, 0.3, 1e-6);
}

TEST(Targets, wait_for_the_report_of_their_time_as_long_as_reports_come) {
  auto late = targets();
  late.report(kNow, hc::gaze::rotation({0, 0}));
  late.see(kNow + 10 * kMillisecond, kHead, {2, 0, 0.05});
  late.take_in(kNow + 15 * kMillisecond);
  EXPECT_FALSE(late.follower().last());
  late.report(kNow + 20 * kMillisecond, hc::gaze::rotation({0.4, 0}));
  late.take_in(kNow + 25 * kMillisecond);
  EXPECT_NEAR(last(late).pan, 0.2, 1e-6);
  auto silent = targets();
  silent.report(kNow, hc::gaze::rotation({0, 0}));
  silent.see(kNow + 10 * kMillisecond, kHead, {2, 0, 0.05});
  silent.take_in(kNow + 200 * kMillisecond);
  EXPECT_NEAR(last(silent).pan, 0, 1e-6);
}

TEST(Targets, are_looked_at_with_eyes_that_sit_as_they_were_found) {
  auto crooked = targets();
  crooked.know(hc::gaze::HeadCalibration{false, {0.1, 0}, Eigen::Vector3d::Zero(), 0});
  crooked.see(kNow, kRobot,
              Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d(2, 0, 0));
  crooked.take_in(kNow);
  EXPECT_NEAR(last(crooked).pan, 0.2, 1e-3);
}

TEST(Targets, are_seen_by_eyes_that_are_swapped) {
  const double side = 600 * 0.05 / 2;  // of a place 2 m before the middle of the eyes [px]
  for (bool swapped : {false, true}) {
    auto eyes = targets();
    eyes.know(hc::gaze::HeadCalibration{swapped, {}, Eigen::Vector3d::Zero(), 0});
    for (int i = 0; i < 40; ++i) {
      const std::int64_t time = kNow + i * 50 * kMillisecond;
      eyes.see(time, swapped ? kRightImage : kLeftImage, {399.5 + side, 299.5, 0});
      eyes.see(time, swapped ? kLeftImage : kRightImage, {399.5 - side, 299.5, 0});
      eyes.take_in(time);
    }
    EXPECT_NEAR(last(eyes).pan, 0, 1e-3) << swapped;
  }
}

TEST(Targets, pixels_are_without_the_lens_where_it_was_measured) {
  auto cameras = hc::vision::ideal_pair({800, 600}, 500, 0.2);
  cameras.D1 = {-0.2, 0, 0, 0, 0};
  auto measured = targets();
  ASSERT_TRUE(measured.know(cameras));
  measured.see(kNow, kLeftImage, {100, 299.5, 0});
  measured.take_in(kNow);
  auto ideal = targets();
  ideal.see(kNow, kLeftImage, {100, 299.5, 0});
  ideal.take_in(kNow);
  EXPECT_GT(last(measured).pan, last(ideal).pan + 0.05);
  cameras.head = {1, 2};
  EXPECT_FALSE(measured.know(cameras));
}

TEST(Targets, a_clock_that_is_set_back_is_gone_by) {
  auto one = targets();
  one.report(kNow, hc::gaze::rotation({1, 0}));
  one.report(kNow - 3'600'000 * kMillisecond, hc::gaze::rotation({0.5, 0}));
  EXPECT_NEAR(hc::gaze::angles_of(one.R_robot_head(kNow)).pan, 0.5, 1e-9);
}

TEST(Targets, only_those_of_known_coordinate_systems_can_be_seen) {
  for (int coord : {2, 3, 7, 8}) EXPECT_TRUE(Targets::can_see(coord));
  for (int coord : {0, 1, 9, 13}) EXPECT_FALSE(Targets::can_see(coord));
}

}  // namespace
