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

}  // namespace
}  // namespace hc::people
