// SPDX-License-Identifier: Apache-2.0
// Uses SDL's virtual joysticks, which exist only in this process.
#include <drivers/joystick/joystick.h>

#include <SDL2/SDL.h>

#include <algorithm>

#include <gtest/gtest.h>

namespace {

using hc::Joystick;

class JoystickTest : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = Joystick::open();
    ASSERT_TRUE(opened);
    joystick = std::move(*opened);
    if (!joystick->state().name.empty()) GTEST_SKIP() << "a real joystick is plugged in";
  }
  void TearDown() override {
    while (SDL_NumJoysticks() > 0 && SDL_JoystickIsVirtual(0) == SDL_TRUE)
      SDL_JoystickDetachVirtual(0);
  }
  /// Waits for a change, limited by the watchdog.
  [[nodiscard]] bool changes() const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!joystick->update())
      if (std::chrono::steady_clock::now() > end) return false;
    return true;
  }
  /// Plugs in a virtual controller and returns its SDL handle.
  SDL_Joystick* plug_in(SDL_JoystickType type = SDL_JOYSTICK_TYPE_GAMECONTROLLER, int hats = 0) {
    const int index = SDL_JoystickAttachVirtual(type, 6, 15, hats);
    EXPECT_GE(index, 0) << SDL_GetError();
    EXPECT_TRUE(changes());
    EXPECT_FALSE(joystick->state().name.empty());
    return SDL_JoystickFromInstanceID(SDL_JoystickGetDeviceInstanceID(index));
  }

  std::unique_ptr<Joystick> joystick;
};

TEST_F(JoystickTest, none_is_no_error) {
  EXPECT_FALSE(joystick->update());
  EXPECT_EQ(joystick->state(), hc::JoystickState{});
}

TEST_F(JoystickTest, axes_are_numbers) {
  SDL_Joystick* pad = plug_in();
  ASSERT_EQ(joystick->state().axes.size(), 6);
  SDL_JoystickSetVirtualAxis(pad, 0, -32768);
  SDL_JoystickSetVirtualAxis(pad, 1, 32767);
  EXPECT_TRUE(changes());
  while (joystick->state().axes[1] == 0) ASSERT_TRUE(changes());
  EXPECT_EQ(joystick->state().axes[0], -1);
  EXPECT_EQ(joystick->state().axes[1], 1);
}

TEST_F(JoystickTest, each_press_and_release_is_a_change) {
  SDL_Joystick* pad = plug_in();
  for (int i = 0; i < 3; ++i)
    for (Uint8 pressed : {Uint8{1}, Uint8{0}}) {
      SDL_JoystickSetVirtualButton(pad, 1, pressed);
      SDL_JoystickUpdate();  // queues the event, which is not yet polled
    }
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(changes());
    EXPECT_EQ(joystick->state().buttons[1], i % 2 == 0 ? 1 : 0) << i;
  }
  EXPECT_FALSE(joystick->update());
}

TEST_F(JoystickTest, one_that_goes_lets_everything_go_and_comes_back) {
  SDL_Joystick* pad = plug_in();
  SDL_JoystickSetVirtualAxis(pad, 0, 20000);
  SDL_JoystickSetVirtualButton(pad, 0, 1);
  while (joystick->state().axes[0] == 0 || joystick->state().buttons[0] == 0)
    ASSERT_TRUE(changes());
  SDL_JoystickDetachVirtual(0);
  const auto& state = joystick->state();
  while (!state.name.empty()) ASSERT_TRUE(changes());  // SDL releases its axes and buttons first
  EXPECT_EQ(state.axes.size(), 6);
  EXPECT_EQ(std::count(state.axes.begin(), state.axes.end(), 0.0), 6);
  EXPECT_EQ(std::count(state.buttons.begin(), state.buttons.end(), 1), 0);
  EXPECT_FALSE(joystick->update());

  pad = plug_in();
  SDL_JoystickSetVirtualAxis(pad, 0, 32767);
  while (joystick->state().axes[0] != 1) ASSERT_TRUE(changes());
}

TEST_F(JoystickTest, the_hats_of_one_without_a_mapping_are_axes) {
  SDL_Joystick* pad = plug_in(SDL_JOYSTICK_TYPE_UNKNOWN, 2);
  ASSERT_EQ(SDL_IsGameController(0), SDL_FALSE);
  const auto& axes = joystick->state().axes;
  ASSERT_EQ(axes.size(), 6 + 2 * 2);
  SDL_JoystickSetVirtualHat(pad, 1, SDL_HAT_LEFTDOWN);
  while (axes[8] == 0) ASSERT_TRUE(changes());
  EXPECT_EQ(axes, (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, -1, 1}));
  SDL_JoystickSetVirtualHat(pad, 1, SDL_HAT_CENTERED);
  SDL_JoystickSetVirtualHat(pad, 0, SDL_HAT_UP);
  while (axes[7] == 0) ASSERT_TRUE(changes());
  EXPECT_EQ(axes, (std::vector<double>{0, 0, 0, 0, 0, 0, 0, -1, 0, 0}));
}

TEST_F(JoystickTest, a_second_one_waits_for_its_turn) {
  plug_in();
  const int index = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, 6, 15, 0);
  const auto second = SDL_JoystickGetDeviceInstanceID(index);
  EXPECT_FALSE(joystick->update());
  SDL_JoystickDetachVirtual(0);
  while (SDL_JoystickFromInstanceID(second) == nullptr) ASSERT_TRUE(changes());
  EXPECT_FALSE(joystick->state().name.empty());
  SDL_JoystickSetVirtualAxis(SDL_JoystickFromInstanceID(second), 1, 32767);
  while (joystick->state().axes[1] != 1) ASSERT_TRUE(changes());
}

}  // namespace
