// SPDX-License-Identifier: Apache-2.0
#include <ros/joints.h>

#include <gtest/gtest.h>
#include <hc/module/kind.h>
#include <hc/testing/must.h>

namespace hc::ros {
namespace {

constexpr const char* kFrames =
    "head 3 robot neck.pose 12; left_eye 4 head 0.06 0.05 0 0 0 0 1; cup 200 head 1 2 3 0 0 1 0";

TEST(GraphJoints, are_fixed_or_moved) {
  const auto joints = must(GraphJoints::read(kFrames));
  EXPECT_EQ(joints.names.at(200), "cup");
  EXPECT_EQ(joints.root, "robot");
  ASSERT_EQ(joints.fixed.size(), 2u);
  EXPECT_EQ(joints.fixed[1].parent, "head");
  EXPECT_EQ(joints.fixed[1].child, "cup");
  EXPECT_EQ(joints.fixed[1].translation, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(joints.fixed[1].rotation, (std::array<double, 4>{0, 0, 1, 0}));
  EXPECT_TRUE(joints.are_moved_by("neck.pose"));
  EXPECT_FALSE(joints.are_moved_by("neck.position"));
}

TEST(GraphJoints, a_pose_moves_the_one_that_it_is_of) {
  const auto joints = must(GraphJoints::read(kFrames));
  const std::array<double, 16> T = {0, -1, 0, 0.5, 1, 0, 0, 0, 0, 0, 1, 0.25, 0, 0, 0, 1};
  hc::Message pose = hc::transformation().message(T);
  pose.header.src = 12;
  pose.header.coord = 2003;
  pose.header.time = unix_time(77);
  const auto joint = must(joints.joint_of(pose));
  EXPECT_EQ(joint.parent, "robot");
  EXPECT_EQ(joint.child, "head");
  EXPECT_EQ(joint.time, unix_time(77));
  EXPECT_EQ(joint.translation, (std::array<double, 3>{0.5, 0, 0.25}));
  EXPECT_NEAR(joint.rotation[2], std::sqrt(0.5), 1e-12);
  pose.header.src = 99;
  pose.header.coord = 7;
  EXPECT_FALSE(joints.joint_of(pose));
}

TEST(GraphJoints, what_is_no_frames_is_refused) {
  EXPECT_FALSE(GraphJoints::read("head 3"));
}

}  // namespace
}  // namespace hc::ros
