// SPDX-License-Identifier: Apache-2.0
#include <people/hand_place.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <people/made_hand_test.h>

namespace hc::people {
namespace {

const vision::Pinhole kCamera{600, 600, 399.5, 299.5};
constexpr double kBaseline = 0.1;  // [m]

/// A made hand, of another size, at a place before the camera, and how an eye sees it.
struct Placed {
  Joints joints;
  Hand left, right;
};
Placed placed(const Eigen::Vector3d& at, const Pose& pose = {}, double size = 1) {
  Placed all{{}, made_hand(pose), made_hand(pose)};
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    const auto& world = all.left.world[i];
    const Eigen::Vector3d p = at + size * Eigen::Vector3d(world.x, world.y, world.z);
    const auto pixel = [&](double x) {
      return cv::Point2f(static_cast<float>(kCamera.fx * x / p.z() + kCamera.cx),
                         static_cast<float>(kCamera.fy * p.y() / p.z() + kCamera.cy));
    };
    all.joints[i] = p;
    all.left.points[i] = pixel(p.x());
    all.right.points[i] = pixel(p.x() - kBaseline);
  }
  return all;
}

void expect_near(const Joints& a, const Joints& b, double most) {
  for (std::size_t i = 0; i < Hand::kPoints; ++i) EXPECT_LT((a[i] - b[i]).norm(), most) << i;
}

TEST(HandPlace, of_a_hand_of_ordinary_size_is_told_by_its_image) {
  for (const Eigen::Vector3d& at : {Eigen::Vector3d(0, 0, 1), {0.3, -0.2, 0.6}, {-0.5, 0.4, 2}}) {
    const Placed hand = placed(at, {0.3F, 1.5F, 2.0F, 0, true, 0.7F});
    const auto joints = joints_of(hand.left, kCamera);
    ASSERT_TRUE(joints);
    expect_near(*joints, hand.joints, 1e-4);
  }
}

TEST(HandPlace, of_another_size_is_told_by_its_depth) {
  const Placed hand = placed({0.2, 0.1, 1.2}, {.index = 0.8F}, 0.8);
  const auto joints = joints_of(hand.left, kCamera);
  ASSERT_TRUE(joints);
  EXPECT_NEAR(depth_of(*joints), depth_of(hand.joints) / 0.8, 1e-3) << "taken for a larger one";
  expect_near(moved_to(*joints, depth_of(hand.joints)), hand.joints, 1e-3);
}

TEST(HandPlace, that_both_eyes_see_is_triangulated) {
  const Placed hand = placed({-0.1, 0.2, 0.8}, {.middle = 2}, 1.3);
  const auto joints = joints_by_eyes(hand.left, hand.right, kCamera, kBaseline);
  ASSERT_TRUE(joints);
  expect_near(*joints, hand.joints, 1e-4);
}

TEST(HandPlace, is_the_same_where_the_right_eye_saw_the_fingers_in_the_other_order) {
  const Placed hand = placed({0.1, -0.05, 0.8});
  const auto joints =
      joints_by_eyes(hand.left, with_fingers_reversed(hand.right), kCamera, kBaseline);
  ASSERT_TRUE(joints);
  expect_near(*joints, hand.joints, 1e-4);
}

TEST(HandPlace, of_a_joint_that_was_mistaken_stays_near_the_others) {
  Placed hand = placed({0, 0, 0.8});
  hand.right.points[Hand::IndexTip].x = hand.left.points[Hand::IndexTip].x + 5;
  const auto joints = joints_by_eyes(hand.left, hand.right, kCamera, kBaseline);
  ASSERT_TRUE(joints);
  EXPECT_NEAR((*joints)[Hand::IndexTip].z(), 0.8 + 0.12, 1e-3);
}

TEST(HandPlace, needs_one_hand_in_both_eyes) {
  Placed hand = placed({0, 0, 0.8});
  EXPECT_FALSE(joints_by_eyes(hand.right, hand.left, kCamera, kBaseline)) << "behind the eyes";
  for (auto& point : hand.right.points) point.y += 40;
  EXPECT_FALSE(joints_by_eyes(hand.left, hand.right, kCamera, kBaseline)) << "another height";
}

TEST(HandPlace, in_the_right_eye_is_to_the_left) {
  const Placed hand = placed({0, 0, 0.8});
  const Region region = region_in_right(hand.left, 600 * kBaseline / 0.8);
  const Region seen = region_of(hand.right);
  EXPECT_NEAR(region.middle.x, seen.middle.x, 1e-2);
  EXPECT_NEAR(region.middle.y, seen.middle.y, 1e-2);
}

TEST(HandPlace, depth_is_read_from_the_palm) {
  const Placed hand = placed({0, 0, 0.8});
  cv::Mat depth(600, 800, CV_32F, cv::Scalar(3));
  EXPECT_EQ(depth_in(depth, hand.left), 3);
  depth(cv::Rect(330, 230, 140, 140)) = 0.79F;
  depth.at<float>(300, 400) = 0;
  EXPECT_EQ(depth_in(depth, hand.left), static_cast<double>(0.79F));
  depth = 0;
  EXPECT_FALSE(depth_in(depth, hand.left)) << "unknown";
  for (const float none : {INFINITY, -INFINITY, NAN}) {
    depth = none;
    EXPECT_FALSE(depth_in(depth, hand.left)) << none;
  }
  EXPECT_FALSE(depth_in(cv::Mat(10, 10, CV_32F, cv::Scalar(1)), hand.left)) << "outside";
}

TEST(HandPlace, of_no_hand_is_none) {
  Hand hand;
  EXPECT_FALSE(joints_of(hand, kCamera)) << "all points are one";
}

}  // namespace
}  // namespace hc::people
