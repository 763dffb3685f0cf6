// SPDX-License-Identifier: Apache-2.0
#include <vision/blob.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

/// Distance of two hues, the shorter way round.
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
  constexpr int kHalf = 2;  // of the averaged square [px]
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

BlobFinder::BlobFinder(const BlobColour& colour)
    : colour_(colour), faint_(colour), table_(table_of(colour)) {
  faint_.min_saturation *= 0.8;
  faint_.min_value *= 0.35;
  faint_table_ = table_of(faint_);
}

BlobFinder::Table BlobFinder::table_of(const BlobColour& colour) {
  constexpr int kLevels = 1 << kBits, kStep = 256 / kLevels;
  Table table(std::size_t{kLevels} * kLevels * kLevels);
  std::size_t at = 0;
  for (int r = 0; r < kLevels; ++r)
    for (int g = 0; g < kLevels; ++g)
      for (int b = 0; b < kLevels; ++b, ++at) {
        constexpr double kMiddle = (kStep - 1) / 2.0;
        const auto hsv =
            hue_saturation_value({r * kStep + kMiddle, g * kStep + kMiddle, b * kStep + kMiddle});
        const bool is_it = hue_distance(hsv[0], colour.hue) <= colour.hue_width &&
                           hsv[1] >= colour.min_saturation && hsv[2] >= colour.min_value;
        table[at] = is_it ? 255 : 0;
      }
  return table;
}

void BlobFinder::mark(const cv::Mat& rgb, const Table& table) {
  cv::blur(rgb, smooth_, {3, 3});
  mask_.create(rgb.size(), CV_8U);
  constexpr int kShift = 8 - kBits;
  for (int y = 0; y < rgb.rows; ++y) {
    const auto* from = smooth_.ptr<std::uint8_t>(y);
    auto* to = mask_.ptr<std::uint8_t>(y);
    for (int x = 0; x < rgb.cols; ++x, from += 3)
      to[x] = table[static_cast<std::size_t>(from[0] >> kShift << (2 * kBits) |
                                             from[1] >> kShift << kBits | from[2] >> kShift)];
  }
  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::morphologyEx(mask_, mask_, cv::MORPH_OPEN, square);
}

std::vector<BlobFinder::Region> BlobFinder::regions(const cv::Mat& rgb, const Table& table) {
  mark(rgb, table);
  const int count = cv::connectedComponentsWithStats(mask_, labels_, sizes_, middles_, 8, CV_32S);
  std::vector<int> labels(static_cast<std::size_t>(std::max(0, count - 1)));
  std::iota(labels.begin(), labels.end(), 1);
  constexpr std::size_t kMost = 20;  // the largest
  const auto area_of = [&](int label) { return sizes_.at<int>(label, cv::CC_STAT_AREA); };
  std::sort(labels.begin(), labels.end(), [&](int a, int b) { return area_of(a) > area_of(b); });
  if (labels.size() > kMost) labels.resize(kMost);
  std::vector<Region> found;
  for (const int label : labels) {
    Region region;
    region.x = middles_.at<double>(label, 0);
    region.y = middles_.at<double>(label, 1);
    region.area = area_of(label);
    region.box = {sizes_.at<int>(label, cv::CC_STAT_LEFT), sizes_.at<int>(label, cv::CC_STAT_TOP),
                  sizes_.at<int>(label, cv::CC_STAT_WIDTH),
                  sizes_.at<int>(label, cv::CC_STAT_HEIGHT)};

    // Holes such as highlights are filled, unless they are most of the blob, as in a frame.
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
    cv::Point2f middle;
    float radius = 0;
    cv::minEnclosingCircle(outlines.front(), middle, radius);
    // The outline runs through the centres of the pixels; the radius reaches their outer edges.
    region.fit = std::min(1.0, region.area / (std::numbers::pi * std::pow(radius + 0.5, 2)));
    found.push_back(region);
  }
  return found;
}

const cv::Mat& BlobFinder::shrink(const cv::Mat& rgb, int scale) {
  if (scale == 1) return rgb;
  const cv::Size size(rgb.cols / scale, rgb.rows / scale);
  const cv::Mat whole = rgb(cv::Rect(0, 0, size.width * scale, size.height * scale));
  cv::resize(whole, small_, size, 0, 0, cv::INTER_AREA);
  return small_;
}

double BlobFinder::score(const Region& region, int scale) const {
  // A square fills 0.64 of its circle; it needs 14 times the area of a disc to win.
  const double likely = std::sqrt(region.area) * std::pow(region.fit, 6);
  if (!last_) return likely;
  const double reach = 3 * last_->radius * (1 + missed_);
  const cv::Point2d expected =
      cv::Point2d(last_->x, last_->y) + (1 + std::min(missed_, 5)) * velocity_;
  const double off = cv::norm(scale * cv::Point2d(region.x, region.y) - expected) / reach;
  const double larger = std::log(scale * std::sqrt(region.area / last_->area)) / 0.7;
  // Blobs far from the prediction remain possible: eyes turn fast.
  return likely * (0.02 + std::exp(-(off * off + larger * larger) / 2));
}

void BlobFinder::remember(const std::optional<Blob>& blob) {
  constexpr int kForgotten = 20;  // images
  if (!blob) {
    if (last_ && ++missed_ > kForgotten) last_.reset();
    return;
  }
  velocity_ =
      last_ ? cv::Point2d(blob->x - last_->x, blob->y - last_->y) / (1 + missed_) : cv::Point2d();
  last_ = blob;
  missed_ = 0;
}

std::optional<Blob> BlobFinder::find(const cv::Mat& rgb, double min_area) {
  if (rgb.empty()) return std::nullopt;
  CV_Assert(rgb.type() == CV_8UC3);
  // About 400 pixels wide: faster, and less noise.
  const int scale = std::max(1, static_cast<int>(std::lround(rgb.cols / 400.0)));
  if (rgb.cols / scale == 0 || rgb.rows / scale == 0) return std::nullopt;
  const auto all = regions(shrink(rgb, scale), table_);
  const auto best = std::max_element(all.begin(), all.end(), [&](const auto& a, const auto& b) {
    return score(a, scale) < score(b, scale);
  });
  constexpr double kMostGrowth = 4;
  if (best == all.end() ||
      (last_ && scale * scale * best->area > kMostGrowth * last_->area && last_->area > min_area)) {
    remember(std::nullopt);
    return std::nullopt;
  }
  Region region = *best;
  // Adjacent darker or paler pixels are included if they make the blob rounder.
  const int grown = static_cast<int>(2 * std::sqrt(region.area)) + 3;
  const cv::Rect small_all({0, 0}, cv::Size(rgb.cols / scale, rgb.rows / scale));
  const auto around = [](const cv::Rect& box, int margin) {
    return box - cv::Point(margin, margin) + cv::Size(2 * margin, 2 * margin);
  };
  const Table* table = &table_;
  const cv::Rect part = around(region.box, grown) & small_all;
  for (auto each : regions(shrink(rgb, scale)(part), faint_table_)) {
    each.box += part.tl();
    each.x += part.x;
    each.y += part.y;
    if ((each.box & region.box) != region.box || each.fit < region.fit + 0.15) continue;
    region = each;
    table = &faint_table_;
    break;
  }
  if (scale > 1) {
    const int margin = 3;  // [small px]
    cv::Rect about = around(region.box, margin);
    about = cv::Rect(about.tl() * scale, about.size() * scale) & cv::Rect({0, 0}, rgb.size());
    const double offset = (scale - 1) / 2.0;  // of the centre of a small pixel
    region.x = scale * region.x + offset;
    region.y = scale * region.y + offset;
    region.area *= scale * scale;
    // A small blob is measured again at full resolution.
    constexpr int kLargest = 160 * 160;
    if (about.area() <= kLargest) {
      const auto fine = regions(rgb(about), *table);
      if (!fine.empty() && 2 * fine.front().area > region.area) {
        region = fine.front();
        region.x += about.x;
        region.y += about.y;
      }
    }
  }
  std::optional<Blob> blob;
  if (region.area >= min_area)
    blob = Blob{region.x, region.y, std::sqrt(region.area / std::numbers::pi), region.area};
  remember(blob);
  return blob;
}

std::optional<BlobColour> BlobFinder::find_faint(const cv::Mat& rgb, double min_area) {
  if (rgb.empty()) return std::nullopt;
  const auto all = regions(rgb, faint_table_);
  if (all.empty() || all.front().area < min_area) return std::nullopt;
  const cv::Scalar mean = cv::mean(rgb(all.front().box), mask_(all.front().box));
  const cv::Vec3d hsv = hue_saturation_value({mean[0], mean[1], mean[2]});
  return BlobColour{hsv[0], colour_.hue_width, hsv[1], hsv[2]};
}

}  // namespace hc::vision
