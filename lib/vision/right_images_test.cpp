// SPDX-License-Identifier: Apache-2.0
#include <vision/right_images.h>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using hc::vision::RightImages;

hc::Message image(std::chrono::milliseconds at) {
  hc::Message made;
  made.header.time = hc::Time(100s) + at;
  return made;
}

/// Whether the image of a time has come.
bool is_there(RightImages& images, std::chrono::milliseconds at) {
  const auto* found = images.find(hc::Time(100s) + at);
  EXPECT_TRUE(!found || found->header.time == hc::Time(100s) + at);
  return found != nullptr;
}

TEST(RightImages, wait_for_left_ones_that_are_late) {
  RightImages images;
  images.add(image(0ms));
  images.add(image(50ms));
  EXPECT_TRUE(is_there(images, 0ms)) << "though the next one has come";
  EXPECT_TRUE(is_there(images, 50ms));
  EXPECT_FALSE(is_there(images, 100ms));
  EXPECT_FALSE(is_there(images, 50ms)) << "older than the last left one";
}

TEST(RightImages, of_later_times_stand_in_nobodys_way) {
  RightImages images;
  images.add(image(1h));
  images.add(image(0ms));
  EXPECT_TRUE(is_there(images, 0ms)) << "the clock was set back";
}

TEST(RightImages, are_not_kept_without_end) {
  RightImages images;
  for (int i = 0; i < 10; ++i) images.add(image(i * 50ms));
  EXPECT_FALSE(is_there(images, 250ms));
  EXPECT_TRUE(is_there(images, 300ms));
}

}  // namespace
