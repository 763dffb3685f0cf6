// SPDX-License-Identifier: Apache-2.0
#include "bidder.h"

#include <gtest/gtest.h>

namespace {

TEST(Script, holds_each_salience_until_the_next) {
  auto script = Script::parse(" 0.5:0.2  1.5:0.9 3:0");
  ASSERT_TRUE(script.has_value());
  EXPECT_EQ(script->at(0), 0);
  EXPECT_EQ(script->at(0.5), 0.2);
  EXPECT_EQ(script->at(1.49), 0.2);
  EXPECT_EQ(script->at(1.5), 0.9);
  EXPECT_EQ(script->at(1e9), 0);
  EXPECT_EQ(Script::parse("")->at(1), 0);
}

TEST(Script, ends_or_starts_over) {
  auto once = *Script::parse("0:0.2 3:end");
  EXPECT_EQ(once.at(2.99), 0.2);
  EXPECT_FALSE(once.at(3).has_value());
  auto again = *Script::parse("0:0.2 1:0.7 3:again");
  EXPECT_EQ(again.at(2.5), 0.7);
  EXPECT_EQ(again.at(3), 0.2);
  EXPECT_EQ(again.at(31), 0.7);
}

TEST(Script, what_is_wrong_is_named) {
  for (const char* bad : {"0", "0:", ":1", "x:1", "0:x", "0:1 0:2", "2:1 1:1", "-1:1", "nan:1",
                          "inf:1", "0:again", "0:1 1:end 2:0"})
    EXPECT_EQ(Script::parse(bad).error().code, hc::Code::Invalid) << bad;
  EXPECT_TRUE(Script::parse("0:nan 1:-1").has_value());  // for the workspace to refuse
}

}  // namespace
