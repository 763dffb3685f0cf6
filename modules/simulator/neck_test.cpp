// SPDX-License-Identifier: Apache-2.0
#include "neck.h"

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;

const Eigen::Quaterniond kAhead = Eigen::Quaterniond::Identity();
const Eigen::Quaterniond kLeft(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));

TEST(Neck, knows_the_delay_after_the_start_without_a_pose) {
  const Neck neck(60ns, hc::unix_time(1000));
  EXPECT_TRUE(neck.knows(hc::unix_time(1059)));
  EXPECT_FALSE(neck.knows(hc::unix_time(1060))) << "a pose of the start may follow";
}

TEST(Neck, knows_all_poses_before_the_newest) {
  Neck neck(60ns, hc::unix_time(1000));
  neck.add(hc::unix_time(1040), kAhead);
  EXPECT_TRUE(neck.knows(hc::unix_time(1099)));
  EXPECT_FALSE(neck.knows(hc::unix_time(1100))) << "another pose of that time may follow";
  neck.add(hc::unix_time(1050), kAhead);
  EXPECT_TRUE(neck.knows(hc::unix_time(1100)));
}

TEST(Neck, takes_each_pose_a_delay_after_its_time) {
  Neck neck(60ns, hc::unix_time(1000));
  neck.add(hc::unix_time(1040), kAhead);
  neck.add(hc::unix_time(1040), kLeft);
  neck.add(hc::unix_time(1050), kAhead);
  EXPECT_FALSE(neck.next(hc::unix_time(1099)));
  EXPECT_EQ(neck.next(hc::unix_time(1100))->time, hc::unix_time(1100));
  EXPECT_EQ(neck.next(hc::unix_time(1100))->R_robot_head.coeffs(), kLeft.coeffs());
  EXPECT_FALSE(neck.next(hc::unix_time(1100)));
  EXPECT_EQ(neck.next(hc::unix_time(2000))->time, hc::unix_time(1110));
  EXPECT_FALSE(neck.next(hc::unix_time(2000)));
}

TEST(Neck, no_time_overflows) {
  Neck neck(60ns, hc::unix_time(1000));
  neck.add(hc::Time::max(), kAhead);
  EXPECT_FALSE(neck.next(hc::unix_time(2000)));
}

}  // namespace
