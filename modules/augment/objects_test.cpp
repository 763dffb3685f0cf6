// SPDX-License-Identifier: Apache-2.0
#include "objects.h"

#include <gtest/gtest.h>

namespace {

TEST(Objects, are_read_with_place_turn_and_size) {
  const auto all = read_objects("cube at world 2 0 0.8 0 0 90 size 0.3; m/robot.glb at 101;");
  ASSERT_TRUE(all) << all.error().text();
  ASSERT_EQ(all->size(), 2U);
  const Object& cube = all->at(0);
  EXPECT_EQ(cube.model, "cube");
  EXPECT_EQ(cube.frame, "world");
  EXPECT_EQ(cube.frame_number, 0);
  EXPECT_EQ(cube.size, 0.3);
  EXPECT_TRUE(
      (cube.T_frame_object * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 1, 0.8)));
  const Object& robot = all->at(1);
  EXPECT_EQ(robot.model, "m/robot.glb");
  EXPECT_EQ(robot.frame_number, 101);
  EXPECT_EQ(robot.size, 0);
  EXPECT_TRUE(robot.T_frame_object.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(Objects, may_be_none) {
  EXPECT_TRUE(read_objects("")->empty());
  EXPECT_TRUE(read_objects(" ; ")->empty());
}

TEST(Objects, that_are_wrong_are_refused_by_name) {
  for (const char* wrong :
       {"cube", "cube at", "cube in world", "cube at 0", "cube at 1000", "cube at world 1 2",
        "cube at world 1 2 3 4", "cube at world x y z", "cube at world 1 2 nan",
        "cube at world 1 2 3 size 0", "cube at world 1 2 3 size", "cube at world 1 2 1e9"}) {
    const auto all = read_objects(std::string("ball at head; ") + wrong);
    ASSERT_FALSE(all) << wrong;
    EXPECT_EQ(all.error().code, hc::Code::Invalid);
    EXPECT_NE(all.error().detail.find(wrong), std::string::npos) << all.error().detail;
  }
}

TEST(Objects, that_are_built_in_are_a_metre_wide) {
  for (const char* model : {"cube", "ball"}) {
    const auto parts = load(model);
    ASSERT_TRUE(parts);
    Eigen::AlignedBox3f bounds;
    for (const auto& vertex : parts->at(0).mesh.vertices) bounds.extend(vertex.position);
    EXPECT_TRUE(bounds.sizes().isApprox(Eigen::Vector3f::Ones(), 1e-3F)) << model;
  }
  EXPECT_FALSE(load("no_such.obj"));
}

}  // namespace
