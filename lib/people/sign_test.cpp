// SPDX-License-Identifier: Apache-2.0
#include <people/sign.h>

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include <people/made_hand_test.h>

namespace hc::people {
namespace {

using namespace std::chrono_literals;

constexpr float kFolded = 2.6F, kQuarter = std::numbers::pi_v<float> / 2;

TEST(Sign, is_told_by_bent_and_straight_fingers) {
  EXPECT_EQ(sign_of(made_hand({})), Sign::Open);
  EXPECT_EQ(sign_of(made_hand({.is_thumb_out = true})), Sign::Open);
  EXPECT_EQ(sign_of(made_hand({kFolded, kFolded, kFolded, kFolded})), Sign::Fist);
  EXPECT_EQ(sign_of(made_hand({0, kFolded, kFolded, kFolded})), Sign::Point);
  EXPECT_EQ(sign_of(made_hand({0, kFolded, kFolded, kFolded, true})), Sign::Point);
  EXPECT_EQ(sign_of(made_hand({0, 0, kFolded, kFolded, false, 0, 0.5F})), Sign::Victory);
  EXPECT_EQ(sign_of(made_hand({kFolded, kFolded, kFolded, kFolded, true, -kQuarter})),
            Sign::ThumbUp);
}

TEST(Sign, two_fingers_side_by_side_point) {
  EXPECT_EQ(sign_of(made_hand({0, 0, kFolded, kFolded})), Sign::Point);
  EXPECT_EQ(sign_of(made_hand({0, 0, kFolded, kFolded, false, 0, 0.2F})), Sign::Point);
  EXPECT_EQ(sign_of(made_hand({0, 0.7F, kFolded, kFolded})), Sign::Point) << "it is a little bent";
}

TEST(Sign, the_last_finger_does_not_count_where_the_index_finger_covers_it) {
  Pose pose{.middle = kFolded, .ring = kFolded};
  EXPECT_EQ(sign_of(made_hand(pose)), Sign::None);
  pose.is_from_side = true;
  EXPECT_EQ(sign_of(made_hand(pose)), Sign::Point);
  pose = {kFolded, kFolded, kFolded, kFolded};
  pose.is_from_side = true;
  EXPECT_EQ(sign_of(made_hand(pose)), Sign::Fist);
}

TEST(Sign, others_are_none) {
  EXPECT_EQ(sign_of(made_hand({0, kFolded, kFolded, 0})), Sign::None);
  EXPECT_EQ(sign_of(made_hand({1.35F, 1.35F, 1.35F, 1.35F})), Sign::None) << "half bent";
  EXPECT_EQ(sign_of(made_hand({kFolded, kFolded, kFolded, kFolded, true})), Sign::None)
      << "the thumb is level";
  EXPECT_EQ(sign_of(made_hand({kFolded, kFolded, kFolded, kFolded, true, kQuarter})), Sign::None)
      << "the thumb is down";
}

TEST(Sign, open_is_held_up_and_point_is_in_any_direction) {
  EXPECT_EQ(sign_of(made_hand({.turn = 0.5F})), Sign::Open);
  EXPECT_EQ(sign_of(made_hand({.turn = kQuarter})), Sign::None);
  EXPECT_EQ(sign_of(made_hand({.turn = 2 * kQuarter})), Sign::None);
  for (const float turn : {-kQuarter, 0.3F, 2 * kQuarter})
    EXPECT_EQ(sign_of(made_hand({0, kFolded, kFolded, kFolded, false, turn})), Sign::Point);
}

class SignHolds : public testing::Test {
 protected:
  /// Shows a sign in images 50 ms apart. @returns how often it is told in these.
  int show(Sign sign, int images) {
    int told = 0;
    for (int i = 0; i < images; ++i, time_ += 50ms)
      if (const auto held = hold_.update(time_, sign)) {
        told_.push_back(*held);
        ++told;
      }
    return told;
  }

  Time time_{100s};
  SignHold hold_;
  std::vector<Sign> told_;
};

TEST_F(SignHolds, tell_once_what_was_held_for_long_enough) {
  EXPECT_EQ(show(Sign::Open, 6), 0) << "250 ms";
  EXPECT_EQ(hold_.held(), Sign::None);
  EXPECT_EQ(show(Sign::Open, 1), 1) << "300 ms";
  EXPECT_EQ(hold_.held(), Sign::Open);
  EXPECT_EQ(show(Sign::Open, 40), 0);
  EXPECT_EQ(show(Sign::None, 10), 0);
  EXPECT_EQ(hold_.held(), Sign::None);
  EXPECT_EQ(show(Sign::Open, 40), 1) << "again";
  EXPECT_EQ(show(Sign::Fist, 40), 1);
  EXPECT_EQ(told_, (std::vector<Sign>{Sign::Open, Sign::Open, Sign::Fist}));
}

TEST_F(SignHolds, overlook_short_mistakes) {
  show(Sign::Point, 4);
  show(Sign::Fist, 2);
  EXPECT_EQ(show(Sign::Point, 1), 1);
  show(Sign::None, 3);
  EXPECT_EQ(show(Sign::Point, 20), 0) << "it is still the same";
}

TEST_F(SignHolds, overlook_longer_mistakes_if_they_may) {
  hold_ = SignHold(SignHold::kHold, SignHold::kLongGap);
  for (int i = 0; i < 2; ++i) {
    show(Sign::Point, 1);
    time_ += 100ms;
    show(Sign::None, 1);
    time_ += 100ms;
  }
  EXPECT_EQ(told_, (std::vector<Sign>{Sign::Point}));
  for (int i = 0; i < 10; ++i) show(i % 2 == 0 ? Sign::None : Sign::Fist, 1);
  EXPECT_NE(hold_.held(), Sign::Point) << "two others in turn";
}

TEST_F(SignHolds, do_not_add_up_what_is_made_again_and_again) {
  for (int i = 0; i < 10; ++i) {
    show(Sign::Open, 4);
    show(Sign::Fist, 4);
  }
  EXPECT_TRUE(told_.empty());
}

TEST_F(SignHolds, count_a_sign_from_where_it_began) {
  show(Sign::Open, 20);
  EXPECT_EQ(show(Sign::Fist, 6), 0);
  EXPECT_EQ(show(Sign::Fist, 1), 1);
}

TEST_F(SignHolds, start_again_where_time_jumps) {
  show(Sign::Open, 6);
  time_ += 10s;
  EXPECT_EQ(show(Sign::Open, 6), 0);
  EXPECT_EQ(show(Sign::Open, 1), 1);
  time_ -= 50s;
  EXPECT_EQ(show(Sign::Open, 7), 1);
}

}  // namespace
}  // namespace hc::people
