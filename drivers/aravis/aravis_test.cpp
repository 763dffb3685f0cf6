// SPDX-License-Identifier: Apache-2.0
#include <drivers/aravis/aravis.h>

#include <gtest/gtest.h>

#include <hc/testing/must.h>

namespace hc::aravis {
namespace {

/// Waits for the next image; the test's watchdog limits the wait.
Result<Image> wait_for_image(Camera& camera) {
  while (true) {
    auto image = camera.next(std::chrono::milliseconds(500));
    if (!image) return image.error();
    if (*image) return **image;
  }
}

TEST(Aravis, gives_images_with_rising_times) {
  auto camera = must(Camera::open("Fake_1"));
  Time before;
  for (int i = 0; i < 3; ++i) {
    auto image = must(wait_for_image(*camera));
    EXPECT_EQ(image.bgr.type(), CV_8UC3);
    EXPECT_GT(image.bgr.cols, 100);
    EXPECT_GT(image.time, before);
    before = image.time;
  }
  EXPECT_GT(before, unix_time(1'700'000'000'000'000'000));
}

TEST(Aravis, a_slow_camera_is_not_lost) {
  auto camera = must(Camera::open("Fake_1", "", 0.6));
  auto first = wait_for_image(*camera);
  auto second = wait_for_image(*camera);
  auto third = wait_for_image(*camera);
  ASSERT_TRUE(first && second && third);
  EXPECT_GT(third->time - second->time, std::chrono::seconds(1));
}

TEST(Aravis, sets_exposure_and_gain) {
  auto camera = must(Camera::open("Fake_1"));
  must(camera->set_exposure(0.012));
  EXPECT_NEAR(camera->exposure().value_or(0), 0.012, 1e-4);
  must(camera->set_gain(3));
  EXPECT_NEAR(camera->gain().value_or(0), 3, 0.1);
  EXPECT_EQ(camera->set_exposure(1e6).error().code, Code::Unsupported);
  EXPECT_TRUE(wait_for_image(*camera));
}

TEST(Aravis, chooses_the_gain_itself_until_it_is_set_and_when_it_is_to_again) {
  auto camera = must(Camera::open("Fake_1"));
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(camera->choose_gain());
    EXPECT_TRUE(camera->chooses_gain().value_or(false));
    ASSERT_TRUE(camera->set_gain(3));
    EXPECT_FALSE(camera->chooses_gain().value_or(true));
  }
  // This camera has a fixed exposure, which is not an error.
  EXPECT_FALSE(camera->chooses_exposure());
  EXPECT_TRUE(camera->choose_exposure());
}

TEST(Aravis, takes_the_pixel_format_that_is_asked_for) {
  for (const char* format : {"Mono8", "BayerRG8", "RGB8"}) {
    auto camera = Camera::open("Fake_1", format);
    if (!camera && camera.error().code == Code::Unsupported) continue;
    ASSERT_TRUE(camera) << format << camera.error().text();
    EXPECT_TRUE(wait_for_image(**camera)) << format;
  }
  EXPECT_EQ(Camera::open("Fake_1", "Nonsense").error().code, Code::Unsupported);
}

TEST(Aravis, says_that_there_is_no_such_camera) {
  EXPECT_EQ(refused(Camera::open("Fake_99")).code, Code::NotFound);
}

}  // namespace
}  // namespace hc::aravis
