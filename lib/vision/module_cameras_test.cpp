// SPDX-License-Identifier: Apache-2.0
#include <vision/module_cameras.h>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include <hc/module/running_module_test.h>

namespace hc::vision {
namespace {

/// With the default head, whose eyes are 0.1 m apart; the log is captured.
class ModuleCameras : public testing::Test {
 protected:
  ModuleCameras() { testing::internal::CaptureStderr(); }
  ~ModuleCameras() override { static_cast<void>(log()); }

  std::string log() {
    if (is_read_) return "";
    is_read_ = true;
    return testing::internal::GetCapturedStderr();
  }
  ParameterState& parameter(std::string_view name) {
    for (const auto& each : ModuleAccess::parameters(module))
      if (each->name == name) return *each;
    throw std::out_of_range(std::string(name));
  }

  Module module{"test", "A test."};
  ModuleFrames frames{module, {.input = false}};
  ModulePair pair{module, frames, "depths have no true scale"};

 private:
  bool is_read_ = false;
};

TEST_F(ModuleCameras, are_assumed_with_a_word_said_once) {
  const auto first = pair.of(640, 480), second = pair.of(640, 480);
  EXPECT_EQ(first.fx, 640);
  EXPECT_EQ(first.fy, 640);
  EXPECT_EQ(first.cx, 319.5);
  EXPECT_EQ(first.cy, 239.5);
  EXPECT_NEAR(second.baseline, 0.1, 1e-9);
  EXPECT_EQ(
      log(),
      "test: assumed: a focal length of 640 px, the image's width, and eyes 0.100 m apart, as "
      "on the default head; depths have no true scale: link intrinsics, or set focal and "
      "baseline\n");
}

TEST_F(ModuleCameras, of_which_half_is_set_are_half_assumed) {
  ASSERT_TRUE(parameter("focal").set("500"));
  EXPECT_EQ(pair.of(640, 480).fx, 500);
  EXPECT_EQ(log(),
            "test: assumed: eyes 0.100 m apart, as on the default head; depths have no "
            "true scale: link intrinsics, or set focal and baseline\n");
}

TEST_F(ModuleCameras, that_are_set_need_no_word) {
  ASSERT_TRUE(parameter("focal").set("500"));
  ASSERT_TRUE(parameter("baseline").set("0.2"));
  EXPECT_EQ(pair.of(640, 480).fx, 500);
  EXPECT_EQ(pair.of(640, 480).baseline, 0.2);
  EXPECT_EQ(log(), "");
}

TEST_F(ModuleCameras, whose_frames_the_graph_gives_are_as_far_apart_as_these) {
  ASSERT_TRUE(parameter("focal").set("500"));
  ASSERT_TRUE(parameter("frames").set(
      "left_eye 4 world 0 0 0 0 0 0 1; right_eye 5 left_eye 0.3 0 0 0 0 0 1"));
  EXPECT_NEAR(pair.of(640, 480).baseline, 0.3, 1e-9);
  EXPECT_EQ(log(), "");
}

TEST_F(ModuleCameras, that_are_linked_are_awaited) {
  const auto images = sink_of("inproc:awaited_images"), linked = sink_of("inproc:awaited_cameras");
  const auto image = module.input("image", table(), "");
  std::vector<double> found;
  module.on(image, [&](const auto& message) {
    const double number = message.numbers()[0];
    pair.when_known([&, number] { found.insert(found.end(), {number, pair.of(640, 480).fx}); });
    if (number != 2) return;
    EXPECT_EQ(found, std::vector<double>{});
    EXPECT_TRUE(linked->send(table().message({500.0, 500.0, 1.0, 1.0, 0.2})));
    EXPECT_TRUE(linked->close());
  });
  for (const double number : {1, 2, 3}) ASSERT_TRUE(images->send(table().message({number})));
  ASSERT_TRUE(images->close());
  EXPECT_EQ(
      run(module, {"--in=image=inproc:awaited_images", "--in=intrinsics=inproc:awaited_cameras"}),
      0);
  EXPECT_EQ(found, (std::vector<double>{1, 500, 2, 500, 3, 500}));
  EXPECT_EQ(log(), "");
}

TEST_F(ModuleCameras, that_are_linked_and_never_come_are_assumed_at_the_end) {
  const auto images = sink_of("inproc:lost_images"), linked = sink_of("inproc:lost_cameras");
  const auto image = module.input("image", table(), "");
  std::vector<double> found;
  module.on(image, [&](const auto& message) {
    pair.when_known([&, number = message.numbers()[0]] {
      found.insert(found.end(), {number, pair.of(640, 480).fx});
    });
    if (message.numbers()[0] == 6) static_cast<void>(linked->close());
  });
  module.on_end([&] { pair.answer_all(); });
  for (const double number : {1, 2, 3, 4, 5, 6})
    ASSERT_TRUE(images->send(table().message({number})));
  ASSERT_TRUE(images->close());
  EXPECT_EQ(run(module, {"--in=image=inproc:lost_images", "--in=intrinsics=inproc:lost_cameras"}),
            0);
  EXPECT_EQ(found, (std::vector<double>{3, 640, 4, 640, 5, 640, 6, 640}));
  const auto text = log();
  EXPECT_NE(text.find("images dropped: intrinsics is linked, but none have come yet"), text.npos);
  EXPECT_NE(text.find("2 without intrinsics"), text.npos) << text;
  EXPECT_NE(text.find("assumed: a focal length of 640 px"), text.npos) << text;
}

TEST_F(ModuleCameras, that_cannot_be_are_refused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::vector<double>& wrong : std::vector<std::vector<double>>{
           {}, {1, 1, 1, 1}, {0, 1, 1, 1, 1}, {1, 1, 1, 1, 0}, {1, -1, 1, 1, 1}, {1, 1, nan, 1, 1}})
    EXPECT_FALSE(PairIntrinsics::of(wrong));
  EXPECT_EQ(PairIntrinsics::of(std::vector<double>{1, 2, 3, 4, 5})->cy, 4);
}

}  // namespace
}  // namespace hc::vision
