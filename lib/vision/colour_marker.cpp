// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <vision/blob.h>
#include <vision/marker_finder.h>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

constexpr double kLeastSide = 12;  // [px]
constexpr double kLeastSaturation = 0.4;
constexpr double kLeastValue = 0.2;

using Quad = std::array<cv::Point2d, 4>;

/// The minimum of red, green and blue: dark where coloured, light where white.
cv::Mat min_channel(const cv::Mat& rgb) {
  cv::Mat channels[3], least;
  cv::split(rgb, channels);
  cv::min(channels[0], channels[1], least);
  cv::min(least, channels[2], least);
  return least;
}

/// A mask of the saturated pixels.
cv::Mat saturated(const cv::Mat& rgb) {
  cv::Mat mask(rgb.size(), CV_8U);
  for (int y = 0; y < rgb.rows; ++y) {
    const auto* from = rgb.ptr<std::uint8_t>(y);
    auto* to = mask.ptr<std::uint8_t>(y);
    for (int x = 0; x < rgb.cols; ++x, from += 3) {
      const int most = std::max({from[0], from[1], from[2]});
      const int span = most - std::min({from[0], from[1], from[2]});
      constexpr int kValue = static_cast<int>(255 * kLeastValue);
      constexpr int kPercent = static_cast<int>(100 * kLeastSaturation);
      to[x] = most >= kValue && 100 * span >= kPercent * most ? 255 : 0;
    }
  }
  return mask;
}

/// The perspective view of a square that matches an outline; clockwise.
std::optional<Quad> quad_of(const std::vector<cv::Point>& outline, double min_side) {
  const double area = cv::contourArea(outline);
  if (area < 0.6 * min_side * min_side) return std::nullopt;
  std::vector<cv::Point> hull, corners;
  cv::convexHull(outline, hull);
  if (area < 0.85 * cv::contourArea(hull)) return std::nullopt;
  for (int percent = 2; percent <= 10; ++percent) {
    cv::approxPolyDP(hull, corners, percent / 100.0 * cv::arcLength(hull, true), true);
    if (corners.size() <= 4) break;
  }
  if (corners.size() != 4 || !cv::isContourConvex(corners)) return std::nullopt;
  // The corners must enclose nearly all of it; a square in a disc encloses 0.64.
  const double inside = cv::contourArea(corners);
  if (inside < 0.8 * cv::contourArea(hull)) return std::nullopt;
  Quad quad;
  std::copy_n(corners.begin(), 4, quad.begin());
  if ((quad[1] - quad[0]).cross(quad[2] - quad[1]) < 0) std::reverse(quad.begin(), quad.end());
  double shortest = 1e9, longest = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double side = cv::norm(quad[i] - quad[(i + 1) % 4]);
    shortest = std::min(shortest, side);
    longest = std::max(longest, side);
  }
  constexpr double kMostStretched = 5;
  if (shortest < min_side / 2 || longest < min_side || longest > kMostStretched * shortest)
    return std::nullopt;
  return quad;
}

/// Rotates the corners so that the upper side points to the right as much as possible.
void turn_upright(Quad& quad) {
  std::size_t first = 0;
  double best = -2;
  for (std::size_t i = 0; i < 4; ++i) {
    // Use both the upper and the lower side because of the perspective.
    const cv::Point2d along =
        (quad[(i + 1) % 4] - quad[i]) + (quad[(i + 2) % 4] - quad[(i + 3) % 4]);
    if (const double right = along.x / cv::norm(along); right > best) {
      best = right;
      first = i;
    }
  }
  std::rotate(quad.begin(), quad.begin() + static_cast<std::ptrdiff_t>(first), quad.end());
}

cv::Vec3d mean_colour(const cv::Mat& rgb, const std::vector<cv::Point2d>& places, int& inside) {
  cv::Vec3d sum;
  inside = 0;
  for (const auto& place : places) {
    const cv::Point at(static_cast<int>(std::lround(place.x)),
                       static_cast<int>(std::lround(place.y)));
    if (!cv::Rect(0, 0, rgb.cols, rgb.rows).contains(at)) continue;
    sum += rgb.at<cv::Vec3b>(at);
    ++inside;
  }
  return inside > 0 ? sum / inside : sum;
}

/// The hue of a square of one colour surrounded by white [degree].
std::optional<int> hue_of(const cv::Mat& rgb, const Quad& quad) {
  const cv::Point2d middle = (quad[0] + quad[1] + quad[2] + quad[3]) / 4;
  std::vector<cv::Point2d> within, about;
  for (std::size_t i = 0; i < 4; ++i)
    for (double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const cv::Point2d rim = quad[i] + share * (quad[(i + 1) % 4] - quad[i]) - middle;
      for (double deep : {0.2, 0.45, 0.7}) within.push_back(middle + deep * rim);
      for (double far : {1.2, 1.3}) about.push_back(middle + far * rim);
    }
  int seen = 0;
  const cv::Vec3d white = mean_colour(rgb, about, seen);
  // Half of the surroundings may be outside the image or hidden.
  if (2 * seen < static_cast<int>(about.size())) return std::nullopt;
  const cv::Vec3d colour = mean_colour(rgb, within, seen);
  const cv::Vec3d hsv = hue_saturation_value(colour), hsv_white = hue_saturation_value(white);
  constexpr double kMostOfWhite = 0.25;  // saturation
  if (hsv[1] < kLeastSaturation || hsv_white[1] > kMostOfWhite || hsv_white[2] < 0.8 * hsv[2])
    return std::nullopt;
  double spread = 0;
  for (const auto& place : within)
    spread += cv::norm(cv::Vec3d(rgb.at<cv::Vec3b>(cv::Point(place))) - colour);
  constexpr double kMostSpread = 60;  // grey levels; noise is below
  if (spread / static_cast<double>(within.size()) > kMostSpread) return std::nullopt;
  return static_cast<int>(std::lround(360 * hsv[0])) % 360;
}

}  // namespace

std::vector<Marker> find_colour_markers(const cv::Mat& rgb) {
  CV_Assert(rgb.type() == CV_8UC3);
  std::vector<Marker> markers;
  constexpr int kHalf = 2;
  const cv::Size size(rgb.cols / kHalf, rgb.rows / kHalf);
  if (size.width < 8 || size.height < 8) return markers;
  cv::Mat small, smooth;
  cv::resize(rgb(cv::Rect(0, 0, size.width * kHalf, size.height * kHalf)), small, size, 0, 0,
             cv::INTER_AREA);
  cv::blur(small, smooth, {3, 3});
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(saturated(smooth), outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  cv::Mat least;  // made when needed
  for (const auto& outline : outlines) {
    auto quad = quad_of(outline, kLeastSide / kHalf);
    if (!quad) continue;
    for (auto& corner : *quad) corner = corner * kHalf + cv::Point2d(0.5, 0.5);
    const auto hue = hue_of(rgb, *quad);
    if (!hue) continue;
    turn_upright(*quad);
    if (least.empty()) {
      least = min_channel(rgb);
      cv::GaussianBlur(least, least, {3, 3}, 0);
    }
    // The first pass is coarse: its corners were found at half the size.
    constexpr double kFar = 5;  // [px]
    if (!refine_corners(least, *quad, kFar) || !refine_corners(least, *quad)) continue;
    Marker marker{MarkerKind::Colour, *hue, *quad};
    if (marker.mean_side() >= kLeastSide) markers.push_back(marker);
  }
  return markers;
}

}  // namespace hc::vision
