// SPDX-License-Identifier: Apache-2.0
#include <drivers/aravis/pixels.h>

#include <vector>

#include <gtest/gtest.h>

namespace hc::aravis {
namespace {

constexpr int kWidth = 16, kHeight = 12;

std::span<const std::byte> bytes(const std::vector<std::uint8_t>& values) {
  return std::as_bytes(std::span(values));
}

std::uint32_t number(PixelFormat format) {
  return static_cast<std::uint32_t>(format);
}

/// The raw image of a uniform colour from a sensor with a pattern such as "RGGB".
std::vector<std::uint8_t> mosaic(const char* pattern, int red, int green, int blue) {
  std::vector<std::uint8_t> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const char colour = pattern[2 * (y % 2) + x % 2];
      values.push_back(static_cast<std::uint8_t>(colour == 'R'   ? red
                                                 : colour == 'G' ? green
                                                                 : blue));
    }
  return values;
}

TEST(Pixels, Bayer_gives_the_colours_that_were_seen) {
  const std::pair<PixelFormat, const char*> formats[] = {{PixelFormat::BayerRG8, "RGGB"},
                                                         {PixelFormat::BayerBG8, "BGGR"},
                                                         {PixelFormat::BayerGR8, "GRBG"},
                                                         {PixelFormat::BayerGB8, "GBRG"}};
  for (const auto& [format, pattern] : formats) {
    const auto values = mosaic(pattern, 200, 100, 50);
    const auto image = to_bgr(number(format), kWidth, kHeight, bytes(values));
    ASSERT_TRUE(image) << pattern;
    EXPECT_EQ(image->at<cv::Vec3b>(5, 6), cv::Vec3b(50, 100, 200)) << pattern;
  }
}

TEST(Pixels, rgb_and_grey) {
  std::vector<std::uint8_t> values;
  for (int i = 0; i < kWidth * kHeight; ++i) values.insert(values.end(), {1, 2, 3});
  EXPECT_EQ(to_bgr(number(PixelFormat::Rgb8), kWidth, kHeight, bytes(values))->at<cv::Vec3b>(3, 3),
            cv::Vec3b(3, 2, 1));
  EXPECT_EQ(to_bgr(number(PixelFormat::Bgr8), kWidth, kHeight, bytes(values))->at<cv::Vec3b>(3, 3),
            cv::Vec3b(1, 2, 3));
  EXPECT_EQ(to_bgr(number(PixelFormat::Mono8), kWidth, kHeight, bytes(values))->at<cv::Vec3b>(0, 1),
            cv::Vec3b(2, 2, 2));
}

TEST(Pixels, what_stands_behind_the_rows_is_dropped) {
  std::vector<std::uint8_t> values;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      for (int shift : {0, 1, 2}) values.push_back(static_cast<std::uint8_t>(10 * y + shift));
    if (y < kHeight - 1) values.insert(values.end(), {255, 255, 255, 255, 255});
  }
  const auto image = to_bgr(number(PixelFormat::Rgb8), kWidth, kHeight, bytes(values), 5);
  ASSERT_TRUE(image) << image.error().text();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      EXPECT_EQ(image->at<cv::Vec3b>(y, x), cv::Vec3b(static_cast<std::uint8_t>(10 * y + 2),
                                                      static_cast<std::uint8_t>(10 * y + 1),
                                                      static_cast<std::uint8_t>(10 * y)));
  values.pop_back();
  EXPECT_FALSE(to_bgr(number(PixelFormat::Rgb8), kWidth, kHeight, bytes(values), 5));
}

TEST(Pixels, refuses_what_it_does_not_know_and_what_is_cut) {
  const std::vector<std::uint8_t> values(kWidth * kHeight);
  constexpr std::uint32_t kMono16 = 0x01100007;
  EXPECT_FALSE(is_known(kMono16));
  EXPECT_EQ(to_bgr(kMono16, kWidth, kHeight, bytes(values)).error().code, Code::Unsupported);
  EXPECT_EQ(to_bgr(number(PixelFormat::Rgb8), kWidth, kHeight, bytes(values)).error().code,
            Code::Malformed);
  EXPECT_EQ(to_bgr(number(PixelFormat::Mono8), -1, kHeight, bytes(values)).error().code,
            Code::Malformed);
}

}  // namespace
}  // namespace hc::aravis
