// SPDX-License-Identifier: Apache-2.0
#include "aims.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace std::chrono_literals;

Aim aim_at(std::chrono::milliseconds at) {
  return {hc::Time(100s) + at, {Eigen::Vector3d(static_cast<double>(at.count()), 0, 1), {0, 0, 1}}};
}
/// The time of the aim that a depth image takes, or -1.
double taken(Aims& aims, std::chrono::milliseconds at) {
  const auto aim = aims.take(hc::Time(100s) + at);
  return aim ? aim->ray.from.x() : -1;
}

TEST(Aims, wait_for_the_depth_image_of_their_time) {
  Aims aims;
  for (const auto at : {0ms, 100ms, 200ms, 300ms}) aims.add(aim_at(at));
  EXPECT_EQ(taken(aims, 100ms), 100);
  EXPECT_EQ(taken(aims, 290ms), 300);
  EXPECT_EQ(taken(aims, 300ms), -1) << "each once";
}

TEST(Aims, are_not_for_depth_images_of_other_times) {
  Aims aims;
  aims.add(aim_at(0ms));
  aims.add(aim_at(1000ms));
  EXPECT_EQ(taken(aims, 500ms), -1);
  EXPECT_EQ(taken(aims, 840ms), -1);
  EXPECT_EQ(taken(aims, 1150ms), 1000);
}

TEST(Aims, are_too_old_for_the_last_of_all_times) {
  Aims aims;
  aims.add(aim_at(0ms));
  EXPECT_FALSE(aims.take(hc::Time::max()));
  EXPECT_EQ(taken(aims, 0ms), -1) << "it was dropped";
}

TEST(Aims, are_forgotten_where_time_goes_back) {
  Aims aims;
  aims.add(aim_at(1000ms));
  aims.add(aim_at(0ms));
  EXPECT_EQ(taken(aims, 1000ms), -1);
  aims.add(aim_at(50ms));
  EXPECT_EQ(taken(aims, 50ms), 50);
}

TEST(Aims, are_not_kept_without_end) {
  Aims aims;
  for (int i = 0; i < 100; ++i) aims.add(aim_at(i * 100ms));
  EXPECT_EQ(taken(aims, 0ms), -1);
  EXPECT_EQ(taken(aims, 9900ms), 9900);
}

/// An aim in the plane, at an angle. [rad]
Aim aim_towards(double angle, std::chrono::milliseconds at, bool is_from_eye = true) {
  return {hc::Time(100s) + at, {{0, 0, 0}, {std::cos(angle), std::sin(angle), 0}, is_from_eye}};
}

TEST(SteadyAim, needs_three_rays_that_agree) {
  SteadyAim steady;
  EXPECT_FALSE(steady.find());
  steady.add(aim_towards(0.1, 0ms));
  steady.add(aim_towards(2.5, 50ms));
  EXPECT_FALSE(steady.find());
  steady.add(aim_towards(0.12, 100ms));
  ASSERT_TRUE(steady.find());
  EXPECT_NEAR(steady.find()->ray.direction.y(), std::sin(0.11), 0.02);
  EXPECT_EQ(steady.find()->time, hc::Time(100s) + 100ms);
}

TEST(SteadyAim, is_not_found_where_all_differ) {
  SteadyAim steady;
  for (int i = 0; i < 8; ++i) steady.add(aim_towards(0.8 * i, i * 50ms));
  EXPECT_FALSE(steady.find());
}

TEST(SteadyAim, prefers_those_from_the_eye) {
  SteadyAim steady;
  for (int i = 0; i < 4; ++i) steady.add(aim_towards(1, i * 20ms, false));
  EXPECT_NEAR(steady.find()->ray.direction.y(), std::sin(1), 1e-6);
  for (int i = 0; i < 3; ++i) steady.add(aim_towards(0.2, 100ms + i * 20ms));
  EXPECT_NEAR(steady.find()->ray.direction.y(), std::sin(0.2), 1e-6);
}

TEST(SteadyAim, forgets_old_rays) {
  SteadyAim steady;
  for (int i = 0; i < 4; ++i) steady.add(aim_towards(1, i * 20ms));
  steady.add(aim_towards(1, 2s));
  EXPECT_FALSE(steady.find());
}

}  // namespace
