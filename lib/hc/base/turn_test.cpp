// SPDX-License-Identifier: Apache-2.0
#include <hc/base/turn.h>

#include <gtest/gtest.h>

#include <string>

namespace {

using std::chrono_literals::operator""ms;

TEST(Turn, is_of_the_first_until_it_lets_go) {
  hc::Turn<int> turn(100ms);
  EXPECT_EQ(turn.holder(0ms), nullptr);
  EXPECT_TRUE(turn.take(1, 0ms));
  EXPECT_FALSE(turn.take(2, 1ms));
  EXPECT_TRUE(turn.take(1, 2ms));
  turn.release(2);
  EXPECT_FALSE(turn.take(2, 3ms));
  turn.release(1);
  EXPECT_EQ(turn.holder(3ms), nullptr);
  EXPECT_TRUE(turn.take(2, 4ms));
  EXPECT_FALSE(turn.take(1, 5ms));
}

TEST(Turn, is_lost_by_silence_and_others_do_not_prolong_it) {
  hc::Turn<std::string> turn(100ms);
  EXPECT_TRUE(turn.take("left", 0ms));
  for (auto now : {50ms, 99ms, 100ms}) EXPECT_FALSE(turn.take("right", now));
  EXPECT_TRUE(turn.take("right", 101ms));
  EXPECT_FALSE(turn.take("left", 102ms));
  ASSERT_NE(turn.holder(201ms), nullptr);
  EXPECT_EQ(*turn.holder(201ms), "right");
  EXPECT_EQ(turn.holder(202ms), nullptr);
}

}  // namespace
