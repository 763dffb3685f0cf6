// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/changes.h>

#include <gtest/gtest.h>

namespace {

using hc::JoystickState;
using hc::JoystickWatch;

TEST(JoystickWatch, gives_each_change_once) {
  JoystickWatch watch;
  const JoystickState pad{.name = "pad", .axes = {0, 0.5}, .buttons = {0, 1}};
  const auto first = watch.take(pad, 0);
  EXPECT_EQ(first.line, "pad connected");
  EXPECT_TRUE(first.stick && first.axes && first.buttons);
  EXPECT_EQ(watch.stick(), (hc::Stick{0, 0.5}));
  const auto second = watch.take(pad, 0);
  EXPECT_EQ(second.line, "");
  EXPECT_FALSE(second.stick || second.axes || second.buttons);
}

TEST(JoystickWatch, tells_axes_and_buttons_apart) {
  JoystickWatch watch;
  watch.take({"pad", {0, 0, 0}, {0}}, 0.1);
  const auto pressed = watch.take({"pad", {0, 0, 0}, {1}}, 0.1);
  EXPECT_TRUE(pressed.buttons);
  EXPECT_FALSE(pressed.stick || pressed.axes);
  const auto other_axis = watch.take({"pad", {0, 0, 1}, {1}}, 0.1);
  EXPECT_TRUE(other_axis.axes);
  EXPECT_FALSE(other_axis.stick || other_axis.buttons);
}

TEST(JoystickWatch, a_stick_that_moves_in_its_dead_zone_has_not_changed) {
  JoystickWatch watch;
  watch.take({"pad", {0, 0}, {}}, 0.1);
  const auto moved = watch.take({"pad", {0.05, -0.09}, {}}, 0.1);
  EXPECT_TRUE(moved.axes);
  EXPECT_FALSE(moved.stick);
}

TEST(JoystickWatch, says_which_one_came_and_went) {
  JoystickWatch watch;
  watch.take({"pad", {1, 0}, {1}}, 0.1);
  EXPECT_EQ(watch.take({"wheel", {0, 0}, {0}}, 0.1).line, "wheel connected");
  const auto gone = watch.take({"", {0, 0}, {0}}, 0.1);
  EXPECT_EQ(gone.line, "wheel disconnected");
  EXPECT_FALSE(gone.stick || gone.axes || gone.buttons);
}

}  // namespace
