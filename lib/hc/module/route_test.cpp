// SPDX-License-Identifier: Apache-2.0
#include <hc/module/route.h>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

TEST(Route, TakesWhatIsNamed) {
  auto route = parse_route("to=21,-5,-1 peer=eye");
  ASSERT_TRUE(route);
  for (int dst : {21, -5, -1}) EXPECT_TRUE(route->takes(dst)) << dst;
  for (int dst : {0, 5, -2, 22}) EXPECT_FALSE(route->takes(dst)) << dst;
  EXPECT_EQ(route->peer, "eye");
}

TEST(Route, TakesAllByDefault) {
  EXPECT_TRUE(parse_route("")->takes(7));
  EXPECT_TRUE(parse_route("to=*")->takes(-7));
  EXPECT_TRUE(parse_route("peer=eye")->takes(0));
  EXPECT_FALSE(parse_route("to=")->takes(0));
}

TEST(Route, WrongWordsAreRefused) {
  for (const char* words : {"to=2x", "to=1;2", "to=99999999999", "via=x", "peer=", "peer"})
    EXPECT_EQ(parse_route(words).error().code, Code::Invalid) << words;
}

}  // namespace
}  // namespace hc::internal
