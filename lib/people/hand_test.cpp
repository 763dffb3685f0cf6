// SPDX-License-Identifier: Apache-2.0
#include <people/hand.h>

#include <gtest/gtest.h>

#include <people/made_hand_test.h>

namespace hc::people {
namespace {

TEST(Hand, box_is_around_all_points) {
  const cv::Rect2f box = made_hand({}).box();
  EXPECT_NEAR(box.x, 400 - 600 * 0.04F, 1e-3);
  EXPECT_NEAR(box.y, 300 - 600 * 0.112F, 1e-3) << "tips";
  EXPECT_NEAR(box.br().y, 300 + 600 * 0.07F, 1e-3) << "wrist";
}

TEST(Hand, region_is_twice_the_palm_and_a_little_ahead) {
  // From the wrist, 0.07 m below, to the first joints of the fingers, 0.065 m above.
  const Region region = region_of(made_hand({}));
  const float palm = 600 * 0.135F;
  EXPECT_NEAR(region.side, 2 * palm, 1e-3);
  EXPECT_NEAR(region.middle.x, 400 - 600 * 0.01F, 1e-3);
  EXPECT_NEAR(region.middle.y, 300 + 600 * 0.0025F - 0.1F * palm, 1e-3);
  EXPECT_NEAR(region.turn, 0, 1e-3);
}

TEST(Hand, region_turns_with_the_hand) {
  const Region upright = region_of(made_hand({}));
  for (const float turn : {-2.9F, -1.0F, 0.4F, 2.0F}) {
    const Region turned = region_of(made_hand({.turn = turn}));
    EXPECT_NEAR(turned.turn, upright.turn + turn, 1e-4);
    EXPECT_NEAR(turned.side, upright.side, 1e-2);
    const cv::Point2f from = upright.middle - cv::Point2f(400, 300);
    EXPECT_NEAR(turned.middle.x, 400 + std::cos(turn) * from.x - std::sin(turn) * from.y, 1e-2);
    EXPECT_NEAR(turned.middle.y, 300 + std::sin(turn) * from.x + std::cos(turn) * from.y, 1e-2);
  }
}

TEST(Hand, bend_is_the_angle_between_the_first_and_the_last_bone) {
  const Hand hand = made_hand({.index = 0.3F, .little = 2});
  EXPECT_NEAR(bend(hand, Hand::Index), 0.3F, 1e-5F);
  EXPECT_NEAR(bend(hand, Hand::Middle), 0, 1e-5F);
  EXPECT_NEAR(bend(hand, Hand::Little), 2, 1e-5F);
}

TEST(Hand, the_finger_that_points_is_the_index_finger_where_it_is_seen_from_its_side) {
  Pose pose{.index = 2, .middle = 2.1F, .ring = 2.2F, .is_from_side = true};
  const Hand taken = made_hand(pose), told = with_index_finger(taken);
  EXPECT_EQ(told.points[Hand::IndexTip], taken.points[Hand::LittleTip]);
  EXPECT_EQ(told.points[Hand::Index], taken.points[Hand::Little]);
  EXPECT_EQ(told.points[Hand::MiddleTip], taken.points[Hand::RingTip]);
  EXPECT_EQ(told.world[Hand::LittleTip], taken.world[Hand::IndexTip]);
  EXPECT_EQ(told.points[Hand::ThumbTip], taken.points[Hand::ThumbTip]);
  EXPECT_EQ(with_index_finger(told).points, told.points);
  pose.is_from_side = false;
  const Hand front = made_hand(pose);
  EXPECT_EQ(with_index_finger(front).points, front.points) << "the little finger alone";
}

}  // namespace
}  // namespace hc::people
