// SPDX-License-Identifier: Apache-2.0
#include <vision/blob.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

/// How far two hues are from one another, the shorter way round.
double hue_distance(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 1 - d);
}

}  // namespace

cv::Vec3d hue_saturation_value(const cv::Vec3d& rgb) {
  const double r = rgb[0], g = rgb[1], b = rgb[2];
  const double most = std::max({r, g, b}), span = most - std::min({r, g, b});
  if (span <= 0) return {0, 0, most / 255};
  double sixths = 0;
  if (most == r)
    sixths = (g - b) / span;
  else if (most == g)
    sixths = 2 + (b - r) / span;
  else
    sixths = 4 + (r - g) / span;
  return {sixths < 0 ? sixths / 6 + 1 : sixths / 6, span / most, most / 255};
}

std::optional<BlobColour> colour_at(const cv::Mat& rgb, cv::Point at) {
  constexpr int kHalf = 2;  // of the square whose mean is taken [px]
  const cv::Rect near(at.x - kHalf, at.y - kHalf, 2 * kHalf + 1, 2 * kHalf + 1);
  const cv::Scalar mean = cv::mean(rgb(near & cv::Rect(0, 0, rgb.cols, rgb.rows)));
  const cv::Vec3d hsv = hue_saturation_value({mean[0], mean[1], mean[2]});
  constexpr double kLeastSaturation = 0.15, kLeastValue = 0.08;
  if (hsv[1] < kLeastSaturation || hsv[2] < kLeastValue) return std::nullopt;
  BlobColour colour;
  colour.hue = hsv[0];
  colour.min_saturation = 0.55 * hsv[1];
  colour.min_value = 0.45 * hsv[2];
  return colour;
}

void BlobFinder::fill_table() {
  constexpr int kLevels = 1 << kBits, kStep = 256 / kLevels;
  table_.resize(std::size_t{kLevels} * kLevels * kLevels);
  std::size_t at = 0;
  for (int r = 0; r < kLevels; ++r)
    for (int g = 0; g < kLevels; ++g)
      for (int b = 0; b < kLevels; ++b, ++at) {
        constexpr double kMiddle = (kStep - 1) / 2.0;
        const auto hsv =
            hue_saturation_value({r * kStep + kMiddle, g * kStep + kMiddle, b * kStep + kMiddle});
        const bool is_it = hue_distance(hsv[0], colour_.hue) <= colour_.hue_width &&
                           hsv[1] >= colour_.min_saturation && hsv[2] >= colour_.min_value;
        table_[at] = is_it ? 255 : 0;
      }
}

std::optional<BlobFinder::Region> BlobFinder::largest(const cv::Mat& rgb) {
  cv::blur(rgb, smooth_, {3, 3});
  mask_.create(rgb.size(), CV_8U);
  constexpr int kShift = 8 - kBits;
  for (int y = 0; y < rgb.rows; ++y) {
    const auto* from = smooth_.ptr<std::uint8_t>(y);
    auto* to = mask_.ptr<std::uint8_t>(y);
    for (int x = 0; x < rgb.cols; ++x, from += 3)
      to[x] = table_[static_cast<std::size_t>(from[0] >> kShift << (2 * kBits) |
                                              from[1] >> kShift << kBits | from[2] >> kShift)];
  }
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::morphologyEx(mask_, mask_, cv::MORPH_OPEN, square);

  const int count = cv::connectedComponentsWithStats(mask_, labels_, sizes_, middles_, 8, CV_32S);
  int label = 0, pixels = 0;
  for (int each = 1; each < count; ++each)
    if (const int area = sizes_.at<int>(each, cv::CC_STAT_AREA); area > pixels) {
      label = each;
      pixels = area;
    }
  if (label == 0) return std::nullopt;
  Region region;
  region.x = middles_.at<double>(label, 0);
  region.y = middles_.at<double>(label, 1);
  region.area = pixels;
  region.box = {sizes_.at<int>(label, cv::CC_STAT_LEFT), sizes_.at<int>(label, cv::CC_STAT_TOP),
                sizes_.at<int>(label, cv::CC_STAT_WIDTH),
                sizes_.at<int>(label, cv::CC_STAT_HEIGHT)};

  // A highlight is a hole: it counts, unless it is what makes the most of the blob, as in a frame.
  cv::Mat filled = cv::Mat::zeros(region.box.size(), CV_8U);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(labels_(region.box) == label, outlines, cv::RETR_EXTERNAL,
                   cv::CHAIN_APPROX_NONE);
  cv::drawContours(filled, outlines, -1, 1, cv::FILLED);
  const cv::Moments moments = cv::moments(filled, true);
  constexpr double kMostHoles = 0.5;  // of the filled blob
  if (region.area > (1 - kMostHoles) * moments.m00) {
    region.x = region.box.x + moments.m10 / moments.m00;
    region.y = region.box.y + moments.m01 / moments.m00;
    region.area = moments.m00;
  }
  return region;
}

std::optional<Blob> BlobFinder::find(const cv::Mat& rgb, double min_area) {
  if (rgb.empty()) return std::nullopt;
  CV_Assert(rgb.type() == CV_8UC3);
  // About 400 pixels wide: less to do, and less noise.
  const int scale = std::max(1, static_cast<int>(std::lround(rgb.cols / 400.0)));
  const cv::Size size(rgb.cols / scale, rgb.rows / scale);
  if (size.area() == 0) return std::nullopt;
  auto region = [&] {
    if (scale == 1) return largest(rgb);
    const cv::Mat whole = rgb(cv::Rect(0, 0, size.width * scale, size.height * scale));
    cv::resize(whole, small_, size, 0, 0, cv::INTER_AREA);
    return largest(small_);
  }();
  if (!region) return std::nullopt;
  if (scale > 1) {
    const int margin = 3;  // [small px]
    cv::Rect about = region->box - cv::Point(margin, margin) + cv::Size(2 * margin, 2 * margin);
    about = cv::Rect(about.tl() * scale, about.size() * scale) & cv::Rect({0, 0}, rgb.size());
    const double offset = (scale - 1) / 2.0;  // of the middle of a small pixel
    region->x = scale * region->x + offset;
    region->y = scale * region->y + offset;
    region->area *= scale * scale;
    // One that is small is looked at once more, where it is, in full.
    constexpr int kLargest = 160 * 160;
    if (about.area() <= kLargest)
      if (auto fine = largest(rgb(about)); fine && 2 * fine->area > region->area) {
        region = fine;
        region->x += about.x;
        region->y += about.y;
      }
  }
  if (region->area < min_area) return std::nullopt;
  return Blob{region->x, region->y, std::sqrt(region->area / std::numbers::pi), region->area};
}

}  // namespace hc::vision
