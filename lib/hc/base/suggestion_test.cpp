// SPDX-License-Identifier: Apache-2.0
#include <hc/base/suggestion.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Suggestion, IsNearOrNothing) {
  EXPECT_EQ(suggestion("camra", {"depth", "camera"}), ", did you mean \"camera\"?");
  EXPECT_EQ(suggestion("wheel", {"depth", "camera"}), "");
  EXPECT_EQ(suggestion("raet", {"rare", "rate"}), ", did you mean \"rate\"?");  // swapped
  EXPECT_EQ(suggestion("pos", {"port", "pose"}), ", did you mean \"pose\"?");
  EXPECT_EQ(suggestion("brihtnes", {"brightness"}), ", did you mean \"brightness\"?");
}

TEST(Suggestion, MayHaveThePrefixOfAnIncludedGraph) {
  EXPECT_EQ(suggestion("workspace.standings", {"eyes.left", "robot_workspace.standings"}),
            ", did you mean \"robot_workspace.standings\"?");
  EXPECT_EQ(suggestion("eyes.left", {"head_eyes.left", "eyes.lift"}),
            ", did you mean \"eyes.lift\"?");
  for (const char* name : {"space.focus", "ft", "", "workspace.focus.x"})
    EXPECT_EQ(suggestion(name, {"robot_workspace.focus", "eye_ft"}), "") << name;
}

TEST(Suggestion, IsNotAnotherWordOfThatLength) {
  for (const char* name : {"", "x", "foo", "left", "speed"})
    EXPECT_EQ(suggestion(name, {"y", "to", "keep", "min", "depth"}), "") << name;
}

}  // namespace
}  // namespace hc
