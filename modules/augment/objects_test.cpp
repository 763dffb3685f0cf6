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
  EXPECT_EQ(cube.frame.name, "world");
  EXPECT_EQ(cube.frame.number, 0);
  EXPECT_FALSE(cube.other);
  EXPECT_EQ(cube.size, 0.3);
  EXPECT_TRUE(
      (cube.T_frame_object * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 1, 0.8)));
  const Object& robot = all->at(1);
  EXPECT_EQ(robot.model, "m/robot.glb");
  EXPECT_EQ(robot.frame.number, 101);
  EXPECT_EQ(robot.size, 0);
  EXPECT_TRUE(robot.T_frame_object.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(Objects, may_have_a_name_in_quotes) {
  const auto all =
      read_objects(R"("my models/a; b.obj" at world 1 2 3; "c d.stl" at 101 size 2;cube at head)");
  ASSERT_TRUE(all) << all.error().text();
  ASSERT_EQ(all->size(), 3U);
  EXPECT_EQ(all->at(0).model, "my models/a; b.obj");
  EXPECT_EQ(all->at(0).T_frame_object.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(all->at(1).model, "c d.stl");
  EXPECT_EQ(all->at(2).model, "cube");
  for (const char* text : {"\"", "\"a.obj at world", "\"\" at world", "\"a.obj\"", "a.obj \" at 1"})
    EXPECT_FALSE(read_objects(text)) << text;
}

TEST(Objects, are_read_that_are_between_two_frames) {
  const auto all = read_objects(
      "s.obj at 101 to 102 size fit; s.obj at 101 to head 0 0 1 size 2; s.obj at 1 to 2");
  ASSERT_TRUE(all) << all.error().text();
  ASSERT_EQ(all->size(), 3U);
  EXPECT_EQ(all->at(0).frame.number, 101);
  EXPECT_EQ(all->at(0).other->number, 102);
  EXPECT_TRUE(all->at(0).fits);
  EXPECT_EQ(all->at(1).other->name, "head");
  EXPECT_EQ(all->at(1).T_frame_object.translation().z(), 1);
  EXPECT_EQ(all->at(1).size, 2);
  EXPECT_FALSE(all->at(1).fits);
  EXPECT_FALSE(all->at(2).fits);
}

TEST(Objects, between_two_points_go_from_one_to_the_other) {
  for (const Eigen::Vector3d& to : {Eigen::Vector3d(3, 2, 1.5), Eigen::Vector3d(-2, 2, 1.5),
                                    Eigen::Vector3d(1, 2, 9), Eigen::Vector3d(1, 2, -9)}) {
    const Eigen::Vector3d from(1, 2, 1);
    const auto T = between_points(from, to);
    EXPECT_TRUE(T.translation().isApprox((from + to) / 2));
    EXPECT_TRUE((T * Eigen::Vector3d((to - from).norm() / 2, 0, 0)).isApprox(to));
    EXPECT_NEAR((T.linear().transpose() * T.linear() - Eigen::Matrix3d::Identity()).norm(), 0,
                1e-9);
    EXPECT_NEAR(T.linear().determinant(), 1, 1e-9);
    EXPECT_NEAR(T.linear()(2, 1), 0, 1e-9) << "y is level";
    EXPECT_GE(T.linear()(2, 2), 0) << "z is up";
  }
}

TEST(Objects, may_be_none) {
  EXPECT_TRUE(read_objects("")->empty());
  EXPECT_TRUE(read_objects(" ; ")->empty());
}

TEST(Objects, that_are_wrong_are_refused_by_name) {
  for (const char* wrong :
       {"cube", "cube at", "cube in world", "cube at 0", "cube at 1000", "cube at world 1 2",
        "cube at world 1 2 3 4", "cube at world x y z", "cube at world 1 2 nan", "cube at world to",
        "cube at world to 0", "cube at 1 to 2 3", "cube at 1 size fit",
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
