// SPDX-License-Identifier: Apache-2.0
#include "palm_stop.h"

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using hc::people::Sign;

constexpr std::optional<std::uint8_t> kNothing, kClear = 0, kHalt = 1;

TEST(PalmStop, is_said_again_each_second_while_a_palm_is_up) {
  PalmStop stop;
  int said = 0;
  for (auto now = 10s + 0ms; now < 13s; now += 50ms) said += stop.update(now, Sign::Open) == kHalt;
  EXPECT_EQ(said, 3);
}

TEST(PalmStop, of_two_palms_is_one) {
  PalmStop stop;
  EXPECT_EQ(stop.update(10s, Sign::Open), kHalt);
  EXPECT_EQ(stop.update(10100ms, Sign::Open), kNothing);
}

TEST(PalmStop, is_cleared_by_a_thumb_once_no_palm_is_up) {
  PalmStop stop;
  EXPECT_EQ(stop.update(9s, Sign::ThumbUp), kNothing) << "nothing is stopped";
  stop.update(10s, Sign::Open);
  EXPECT_EQ(stop.update(10500ms, Sign::ThumbUp), kNothing) << "another's palm is up";
  EXPECT_EQ(stop.update(11500ms, Sign::Point), kNothing);
  EXPECT_EQ(stop.update(11600ms, Sign::ThumbUp), kClear);
  EXPECT_EQ(stop.update(11700ms, Sign::ThumbUp), kNothing);
  EXPECT_EQ(stop.update(11800ms, Sign::Open), kHalt) << "at once";
}

}  // namespace
