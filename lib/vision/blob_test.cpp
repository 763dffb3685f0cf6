// SPDX-License-Identifier: Apache-2.0
#include <vision/blob.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <string>

#include <opencv2/imgproc.hpp>

#include <hc/testing/must.h>

namespace hc::vision {
namespace {

/// A disc with an anti-aliased rim, as in a camera image.
void draw_disc(cv::Mat& image, cv::Point2d at, double radius, const cv::Scalar& rgb) {
  constexpr int kShift = 8;
  const double scale = 1 << kShift;
  cv::circle(image, cv::Point(cv::Point2d(at * scale)),
             static_cast<int>(std::lround(radius * scale)), rgb, cv::FILLED, cv::LINE_AA, kShift);
}

cv::Mat room(cv::Size size = {800, 600}) {
  cv::Mat image(size, CV_8UC3);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      image.at<cv::Vec3b>(y, x) = {static_cast<std::uint8_t>(90 + x % 70),
                                   static_cast<std::uint8_t>(100 + y % 50), 110};
  return image;
}

void add_noise(cv::Mat& image, double sigma, std::uint64_t seed) {
  cv::Mat noise(image.size(), CV_16SC3), sum;
  cv::RNG(seed).fill(noise, cv::RNG::NORMAL, 0, sigma);
  image.convertTo(sum, CV_16S);
  sum += noise;
  sum.convertTo(image, CV_8U);
}

const cv::Scalar kRed(205, 22, 22), kGreen(20, 190, 20), kBlue(30, 40, 200);

TEST(HueSaturationValue, AreThoseOfKnownColours) {
  EXPECT_EQ(hue_saturation_value({255, 0, 0}), cv::Vec3d(0, 1, 1));
  EXPECT_NEAR(hue_saturation_value({0, 255, 0})[0], 1.0 / 3, 1e-12);
  EXPECT_NEAR(hue_saturation_value({0, 0, 255})[0], 2.0 / 3, 1e-12);
  EXPECT_NEAR(hue_saturation_value({255, 0, 1})[0], 1, 1e-3) << "round the circle";
  EXPECT_EQ(hue_saturation_value({0, 0, 0}), cv::Vec3d(0, 0, 0));
  EXPECT_DOUBLE_EQ(hue_saturation_value({200, 100, 100})[1], 0.5);
}

class BlobSize : public testing::TestWithParam<double> {};

TEST_P(BlobSize, IsFoundToAPartOfAPixel) {
  const double radius = GetParam();
  BlobFinder finder{BlobColour{}};
  for (int i = 0; i < 10; ++i) {
    cv::Mat image = room();
    const cv::Point2d at(300 + 13.37 * i, 200 + 7.21 * i);
    draw_disc(image, at, radius, kRed);
    auto blob = must(finder.find(image, 20));
    EXPECT_LT(std::hypot(blob.x - at.x, blob.y - at.y), 0.35) << "px";
    EXPECT_NEAR(blob.radius, radius, 0.04 * radius + 0.9) << "px";
    EXPECT_NEAR(blob.area, std::numbers::pi * blob.radius * blob.radius, 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Radii, BlobSize, testing::Values(6, 10, 25, 80, 180));

TEST(Blob, IsFoundInNoiseBesideSmallerOnes) {
  BlobFinder finder{BlobColour{}};
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    cv::Mat image = room();
    const cv::Point2d at(150 + 11.3 * i, 420 - 6.7 * i);
    draw_disc(image, at, 22, kRed);
    for (int other = 0; other < 8; ++other) draw_disc(image, {60.0 + 95 * other, 560}, 14, kRed);
    cv::rectangle(image, {20, 20, 200, 6}, kRed, cv::FILLED);
    draw_disc(image, {600, 480}, 50, kGreen);
    draw_disc(image, {700, 300}, 50, kBlue);
    add_noise(image, 20, static_cast<std::uint64_t>(i));
    auto blob = must(finder.find(image, 60));
    worst = std::max(worst, std::hypot(blob.x - at.x, blob.y - at.y));
    EXPECT_NEAR(blob.radius, 22, 1.5);
  }
  EXPECT_LT(worst, 0.8) << "px";
}

TEST(Blob, NoiseAloneIsNone) {
  BlobFinder finder{BlobColour{}};
  int found = 0;
  for (int i = 0; i < 20; ++i) {
    cv::Mat image = room();
    draw_disc(image, {400, 300}, 60, kGreen);
    add_noise(image, 20, static_cast<std::uint64_t>(100 + i));
    found += finder.find(image, 60).has_value();
  }
  EXPECT_EQ(found, 0);
  EXPECT_FALSE(finder.find(cv::Mat(), 0));
  EXPECT_FALSE(finder.find(cv::Mat::zeros(1, 1, CV_8UC3), 0));
}

TEST(Blob, AHighlightDoesNotMoveIt) {
  cv::Mat image = room();
  draw_disc(image, {400, 300}, 60, kRed);
  draw_disc(image, {385, 280}, 20, cv::Scalar::all(255));
  auto blob = BlobFinder{BlobColour{}}.find(image, 60);
  ASSERT_TRUE(blob);
  EXPECT_LT(std::hypot(blob->x - 400, blob->y - 300), 0.3);
  EXPECT_NEAR(blob->radius, 60, 1.5);
}

TEST(Blob, AreaHueAndSmallImagesCount) {
  cv::Mat image = room({160, 120});
  draw_disc(image, {80, 60}, 10, kGreen);
  BlobColour green;
  green.hue = 1.0 / 3;
  EXPECT_FALSE(BlobFinder{BlobColour{}}.find(image, 20));
  auto blob = must(BlobFinder{green}.find(image, 20));
  EXPECT_NEAR(blob.x, 80, 0.3);
  EXPECT_FALSE(BlobFinder{green}.find(image, 2 * blob.area));
}

/// The number of images of a rolling ball in which it is found at its position.
int follow(const std::function<void(cv::Mat&)>& behind,
           const std::function<void(cv::Mat&, cv::Point2d)>& before) {
  BlobFinder finder{BlobColour{}};
  int right = 0;
  for (int i = 0; i < 60; ++i) {
    cv::Mat image = room();
    behind(image);
    const cv::Point2d at(120 + 9.3 * i, 250 + 60 * std::sin(0.1 * i));
    draw_disc(image, at, 24, kRed);
    before(image, at);
    add_noise(image, 4, static_cast<std::uint64_t>(i));
    const auto blob = finder.find(image, 60);
    right += blob && std::hypot(blob->x - at.x, blob->y - at.y) < 4;
  }
  return right;
}

TEST(Blob, IsFollowedBesideLargerThingsOfItsColour) {
  const auto floor = [](cv::Mat& image) { cv::rectangle(image, {0, 480, 800, 120}, kRed, -1); };
  const auto square = [](cv::Mat& image) { cv::rectangle(image, {300, 20, 120, 120}, kRed, -1); };
  const auto ball = [](cv::Mat& image) { draw_disc(image, {600, 500}, 20, kRed); };
  for (const auto& [name, behind] : std::map<std::string, std::function<void(cv::Mat&)>>{
           {"nothing", [](cv::Mat&) {}}, {"floor", floor}, {"square", square}, {"ball", ball}})
    EXPECT_EQ(follow(behind, [](cv::Mat&, cv::Point2d) {}), 60) << name;
}

TEST(Blob, IsFollowedThoughALargerBallIsSeenLater) {
  BlobFinder finder{BlobColour{}};
  for (int i = 0; i < 40; ++i) {
    cv::Mat image = room();
    const cv::Point2d at(120 + 9.3 * i, 250);
    draw_disc(image, at, 24, kRed);
    if (i > 10) draw_disc(image, {600, 480}, 45, kRed);
    const auto blob = must(finder.find(image, 60));
    EXPECT_LT(std::hypot(blob.x - at.x, blob.y - at.y), 1) << i;
  }
}

TEST(Blob, IsWholeInShadow) {
  const auto shadow = [](cv::Mat& image, cv::Point2d at) {
    const cv::Rect half = cv::Rect(cvRound(at.x), 0, 800, 600) & cv::Rect({0, 0}, image.size());
    image(half) *= 0.15;
  };
  EXPECT_GE(follow([](cv::Mat&) {}, shadow), 57);
}

TEST(Blob, ThatIsTooDarkIsNamed) {
  cv::Mat image = room();
  draw_disc(image, {400, 300}, 24, kRed);
  image *= 0.2;
  BlobFinder finder{BlobColour{}};
  EXPECT_FALSE(finder.find(image, 60));
  const auto faint = must(finder.find_faint(image, 60));
  EXPECT_NEAR(faint.min_value, 0.16, 0.02);
  EXPECT_FALSE(finder.find_faint(room(), 60));
}

TEST(ColourAt, GivesWhatFindsTheThing) {
  cv::Mat image = room();
  const cv::Scalar ochre(190, 170, 60);
  draw_disc(image, {500, 200}, 30, ochre);
  add_noise(image, 10, 7);
  auto colour = must(colour_at(image, {505, 195}));
  EXPECT_NEAR(colour.hue, 0.141, 0.02);
  auto blob = must(BlobFinder{colour}.find(image, 60));
  EXPECT_LT(std::hypot(blob.x - 500, blob.y - 200), 0.7);
  EXPECT_FALSE(colour_at(cv::Mat(20, 20, CV_8UC3, cv::Scalar::all(128)), {0, 19})) << "grey";
}

}  // namespace
}  // namespace hc::vision
