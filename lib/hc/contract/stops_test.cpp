// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/stops.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Stops, ComeBackFromTheirText) {
  for (const Stops& stops :
       {Stops{}, Stops{{0, true}}, Stops{{-3, false}, {12, true}, {14, false}}})
    EXPECT_EQ(*parse_stops(stops_text(stops)), stops);
  EXPECT_EQ(stops_text({{12, true}, {14, false}}), "12=1,14=0");
}

TEST(Stops, OnlyAStopStops) {
  EXPECT_FALSE(any_stops({}));
  EXPECT_FALSE(any_stops({{1, false}}));
  EXPECT_TRUE(any_stops({{1, false}, {2, true}}));
}

TEST(Stops, WhatIsWrongIsNamed) {
  for (const char* wrong : {"x", "1", "1=", "1=2", "=1", "1=1,", ",1=1", "1=1 ", "99999999999=1"}) {
    const auto read = parse_stops(wrong);
    ASSERT_FALSE(read) << wrong;
    EXPECT_NE(read.error().detail.find("is not SRC=0 or SRC=1"), std::string::npos);
  }
}

}  // namespace
}  // namespace hc
