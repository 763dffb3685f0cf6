// SPDX-License-Identifier: Apache-2.0
#include <people/attention.h>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using hc::people::Attention;
using Reason = Attention::Reason;

constexpr hc::Time kBegin(1'700'000'000s);

class AttentionTest : public testing::Test {
 protected:
  /// Two persons are seen, one to the left and nearer, 20 times a second.
  std::optional<Attention::Choice> look_for(std::chrono::milliseconds period,
                                            std::optional<double> sound = std::nullopt) {
    std::optional<Attention::Choice> choice;
    for (const auto end = now_ + period; now_ < end; now_ += 50ms) {
      attention_.see(1, now_, {0.3, left_});
      attention_.see(2, now_, {-0.3, right_});
      if (sound) attention_.hear(now_, *sound);
      choice = attention_.choose(now_);
    }
    return choice;
  }

  hc::Time now_ = kBegin;
  double left_ = 2, right_ = 3;  // [m]
  Attention attention_{{}};
};

TEST_F(AttentionTest, is_nobodys_where_there_is_nobody) {
  EXPECT_FALSE(attention_.choose(now_));
  attention_.hear(now_, 0);
  EXPECT_FALSE(attention_.choose(now_));
}

TEST_F(AttentionTest, goes_to_the_nearest) {
  EXPECT_EQ(look_for(100ms), (Attention::Choice{1, Reason::Nearest}));
}

TEST_F(AttentionTest, stays_for_a_while_and_until_another_is_clearly_nearer) {
  look_for(1s);
  right_ = 1.5;
  EXPECT_EQ(look_for(500ms)->track, 1) << "two seconds have not passed";
  EXPECT_EQ(look_for(1s)->track, 2);
  left_ = 1.2;
  EXPECT_EQ(look_for(5s)->track, 2) << "hardly nearer";
  left_ = 1;
  EXPECT_EQ(look_for(100ms)->track, 1);
}

TEST_F(AttentionTest, goes_to_the_one_who_speaks_and_stays_when_they_pause) {
  look_for(1s);
  EXPECT_EQ(look_for(300ms, -0.25), (Attention::Choice{2, Reason::Speaks}));
  EXPECT_EQ(look_for(1s)->track, 2) << "a pause";
  EXPECT_EQ(look_for(2s), (Attention::Choice{1, Reason::Nearest}));
}

TEST_F(AttentionTest, changes_between_two_who_speak_in_turn) {
  EXPECT_EQ(look_for(1s, 0.28)->track, 1);
  EXPECT_EQ(look_for(500ms, -0.32)->track, 2);
  EXPECT_EQ(look_for(500ms, 0.32)->track, 1);
}

TEST_F(AttentionTest, is_not_drawn_by_a_click_or_by_sounds_from_nobody) {
  look_for(1s);
  EXPECT_EQ(look_for(50ms, -0.3)->track, 1) << "one short sound";
  EXPECT_EQ(look_for(2s, 1.2)->track, 1) << "an empty room";
}

TEST_F(AttentionTest, holds_on_to_a_person_whoever_speaks) {
  attention_.hold(2);
  EXPECT_EQ(look_for(3s, 0.3), (Attention::Choice{2, Reason::Held}));
  attention_.release();
  EXPECT_EQ(look_for(1s, 0.3), (Attention::Choice{1, Reason::Speaks}));
  attention_.hold(9);
  EXPECT_EQ(look_for(3s, 0.3)->track, 1) << "there is no such person";
}

TEST_F(AttentionTest, says_no_longer_that_somebody_is_held_or_speaks) {
  attention_.hold(1);
  look_for(1s);
  attention_.release();
  EXPECT_EQ(look_for(100ms), (Attention::Choice{1, Reason::Nearest}));
  look_for(500ms, 0.3);
  EXPECT_EQ(look_for(3s), (Attention::Choice{1, Reason::Nearest}));
}

TEST_F(AttentionTest, ends_a_second_after_a_person_was_last_seen) {
  look_for(1s);
  EXPECT_TRUE(attention_.choose(now_ + 900ms));
  EXPECT_FALSE(attention_.choose(now_ + 1100ms));
}

TEST_F(AttentionTest, begins_again_when_the_clock_is_set) {
  look_for(1s);
  now_ -= 1h;
  EXPECT_TRUE(look_for(100ms));
  now_ = hc::Time(1ns);
  EXPECT_TRUE(look_for(100ms));
}

TEST(Attention, says_its_reason_in_a_sentence) {
  EXPECT_EQ(text(Attention::Reason::Nearest), "the nearest");
  EXPECT_EQ(text(Attention::Reason::Speaks), "the speaker");
  EXPECT_EQ(text(Attention::Reason::Held), "held");
}

}  // namespace
