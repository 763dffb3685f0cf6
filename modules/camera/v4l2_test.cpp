// SPDX-License-Identifier: Apache-2.0
#include "v4l2.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include <opencv2/videoio.hpp>

#include "devices.h"

namespace {

using Pairs = std::vector<std::pair<int, double>>;

Pairs pairs(const std::vector<Setting>& settings) {
  Pairs all;
  for (const auto& setting : settings) all.emplace_back(setting.property, setting.value);
  return all;
}

TEST(V4l2, is_asked_for_format_size_and_rate_in_this_order) {
  const auto settings = settings_to_open({800, 600, 30, "MJPG"});
  ASSERT_TRUE(settings);
  EXPECT_EQ(pairs(*settings),
            (Pairs{{cv::CAP_PROP_FOURCC,
                    static_cast<double>(cv::VideoWriter::fourcc('M', 'J', 'P', 'G'))},
                   {cv::CAP_PROP_FRAME_WIDTH, 800},
                   {cv::CAP_PROP_FRAME_HEIGHT, 600},
                   {cv::CAP_PROP_FPS, 30}}));
}

TEST(V4l2, is_asked_for_nothing_that_nobody_wants) {
  EXPECT_TRUE(settings_to_open({})->empty());
  EXPECT_TRUE(settings_to_open({800, 0, 0, ""})->empty());
}

TEST(V4l2, refuses_a_format_that_is_no_fourcc) {
  EXPECT_EQ(settings_to_open({0, 0, 0, "BayerRG8"}).error().code, hc::Code::Unsupported);
}

TEST(V4l2, an_exposure_and_a_gain_are_set_and_refusals_reported) {
  const auto settings = settings_of({0.02, 5}, {100, 1});
  EXPECT_EQ(pairs(settings), (Pairs{{cv::CAP_PROP_AUTO_EXPOSURE, 1},
                                    {cv::CAP_PROP_EXPOSURE, 200},
                                    {cv::CAP_PROP_GAIN, 5}}));
  EXPECT_EQ(settings[0].refusal, "");
  EXPECT_EQ(settings[1].refusal, "exposure not supported");
  EXPECT_EQ(settings[2].refusal, "gain not supported");
}

TEST(V4l2, its_own_choice_is_automatic_or_what_it_was) {
  const auto settings = settings_of({0, -1}, {100, 1});
  EXPECT_EQ(pairs(settings), (Pairs{{cv::CAP_PROP_EXPOSURE, 100},
                                    {cv::CAP_PROP_AUTO_EXPOSURE, 0},
                                    {cv::CAP_PROP_AUTO_EXPOSURE, 3},
                                    {cv::CAP_PROP_GAIN, 1}}));
  for (const auto& setting : settings) EXPECT_EQ(setting.refusal, "");
  EXPECT_EQ(pairs(settings_of({0, -1}, {-1, -1})),
            (Pairs{{cv::CAP_PROP_AUTO_EXPOSURE, 0}, {cv::CAP_PROP_AUTO_EXPOSURE, 3}}));
}

TEST(V4l2, what_differs_is_reported) {
  const CaptureMode mode{800, 600, 30, "MJPG"};
  const double mjpg = cv::VideoWriter::fourcc('M', 'J', 'P', 'G');
  EXPECT_EQ(difference(mode, 800, 600, mjpg), "");
  EXPECT_EQ(difference(mode, 640, 480, mjpg), "gives 640 x 480 pixels instead of 800 x 600");
  EXPECT_EQ(difference(mode, 640, 480, 0),
            "gives 640 x 480 pixels instead of 800 x 600; another pixel format than MJPG");
  EXPECT_EQ(difference(mode, 800, 600, 0), "gives another pixel format than MJPG");
  EXPECT_EQ(difference({}, 640, 480, mjpg), "");
}

TEST(V4l2, a_silent_device_is_lost_after_two_seconds_or_periods) {
  EXPECT_EQ(silence_of({}), 2);
  EXPECT_EQ(silence_of({0, 0, 30, ""}), 2);
  EXPECT_EQ(silence_of({0, 0, 0.3, ""}), 7);
  EXPECT_FALSE(live_camera("/dev/no_such_camera", {0, 0, 0.3, ""}).open());
  EXPECT_STREQ(std::getenv("OPENCV_VIDEOIO_V4L_SELECT_TIMEOUT"), "7");
}

}  // namespace
