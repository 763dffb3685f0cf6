// SPDX-License-Identifier: Apache-2.0
#include "neck.h"

#include <gtest/gtest.h>

#include <frames/rigid.h>

#include "head.h"

namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// Where the head looks to: how far to the left [rad].
double pan(const Neck& neck, std::int64_t time) {
  const Eigen::Vector3d forward = neck.at(time).linear().col(0);
  return std::atan2(forward.y(), forward.x());
}

TEST(Neck, looks_straight_ahead_until_it_is_told) {
  const Neck neck;
  EXPECT_FALSE(neck.awaits(5 * kMillisecond, 5 * kMillisecond));
  const Eigen::Isometry3d straight(Eigen::Translation3d(0, 0, kNeckHeight));
  EXPECT_TRUE(neck.at(5 * kMillisecond).isApprox(straight, 1e-15));
}

TEST(Neck, turns_evenly_between_gazes_and_rests_outside_them) {
  Neck neck;
  neck.add(10 * kMillisecond, hc::frames::rotation(0, 0, 0.1));
  neck.add(20 * kMillisecond, hc::frames::rotation(0, 0, 0.3));
  EXPECT_NEAR(pan(neck, 15 * kMillisecond), 0.2, 1e-12);
  EXPECT_NEAR(pan(neck, 1), 0.1, 1e-12);
  EXPECT_NEAR(pan(neck, 90 * kMillisecond), 0.3, 1e-12);
  EXPECT_EQ(neck.at(15 * kMillisecond).translation(), Eigen::Vector3d(0, 0, kNeckHeight));
}

TEST(Neck, rests_while_nothing_tells_of_it) {
  Neck neck;
  neck.add(1000 * kMillisecond, hc::frames::rotation(0, 0, 0.1));
  neck.add(3000 * kMillisecond, hc::frames::rotation(0, 0, 0.3));
  EXPECT_NEAR(pan(neck, 2900 * kMillisecond), 0.1, 1e-12);
  EXPECT_NEAR(pan(neck, 3000 * kMillisecond), 0.3, 1e-12);
}

}  // namespace
