// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/display.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

constexpr std::array<std::string_view, 6> kLayouts = {"side_by_side", "top_bottom", "red_cyan",
                                                      "rows",         "left",       "right"};

constexpr std::array<std::string_view, 3> kCodings = {"colours", "relief", "fog"};

bool is_known(float value) {
  return std::isfinite(value) && value != 0;
}

/// @param[in,out] bgr  (H, W, 3) u8. @param values  (H, W) f32.
void shade(cv::Mat& bgr, const cv::Mat& values) {
  constexpr double kHeight = 60;  // apparent steepness of the relief
  constexpr double kLeast = 0.35, kMost = 1.3;
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* row = values.ptr<float>(y);
    const auto* above = values.ptr<float>(std::max(0, y - 1));
    auto* pixel = bgr.ptr<cv::Vec3b>(y);
    for (int x = 0; x < bgr.cols; ++x) {
      const float here = row[x], left = row[std::max(0, x - 1)], up = above[x];
      if (!is_known(here) || !is_known(left) || !is_known(up)) continue;
      // Relative, so that slopes look alike near and far.
      const double rise = (double{left} - here + (double{up} - here)) / here;
      const double light = std::clamp(1 - kHeight * rise, kLeast, kMost);
      for (int c = 0; c < 3; ++c)
        pixel[x][c] = cv::saturate_cast<std::uint8_t>(pixel[x][c] * light);
    }
  }
}

/// @param image  (H, W, 3) u8. @param values  (H, W) f32.
cv::Mat faded(const cv::Mat& image, const cv::Mat& values, Span span) {
  constexpr double kFog = 225, kThickest = 0.9;  // its grey level, and its share at the far end
  const double range = span.most > span.least ? span.most - span.least : 1;
  cv::Mat bgr(image.size(), CV_8UC3);
  for (int y = 0; y < bgr.rows; ++y) {
    const auto* row = values.ptr<float>(y);
    const auto* from = image.ptr<cv::Vec3b>(y);
    auto* to = bgr.ptr<cv::Vec3b>(y);
    for (int x = 0; x < bgr.cols; ++x) {
      const double fog = kThickest * std::clamp((row[x] - span.least) / range, 0.0, 1.0);
      for (int c = 0; c < 3; ++c)
        to[x][c] = is_known(row[x])
                       ? cv::saturate_cast<std::uint8_t>(from[x][c] + fog * (kFog - from[x][c]))
                       : std::uint8_t{0};
    }
  }
  return bgr;
}

/// A number with about three digits.
std::string short_number(double value, const std::string& unit) {
  char text[32];
  const double size = std::abs(value);
  std::snprintf(text, sizeof text, size < 10 ? "%.2f" : size < 100 ? "%.1f" : "%.0f", value);
  return unit.empty() ? text : std::string(text) + " " + unit;
}

}  // namespace

std::span<const std::string_view> stereo_layouts() {
  return kLayouts;
}

cv::Mat join_eyes(const cv::Mat& left, const cv::Mat& right, std::string_view layout) {
  CV_Assert(left.size() == right.size() && left.type() == right.type());
  if (layout == "left") return left;
  if (layout == "right") return right;
  cv::Mat joined;
  if (layout == "side_by_side") {
    cv::hconcat(left, right, joined);
  } else if (layout == "top_bottom") {
    cv::vconcat(left, right, joined);
  } else if (layout == "rows") {
    joined = left.clone();
    for (int y = 1; y < joined.rows; y += 2) right.row(y).copyTo(joined.row(y));
  } else {
    CV_Assert(layout == "red_cyan");
    // In grey, since colours that only one eye sees flicker.
    const auto grey = [](const cv::Mat& image) {
      if (image.channels() == 1) return image;
      cv::Mat found;
      cv::cvtColor(image, found, cv::COLOR_BGR2GRAY);
      return found;
    };
    const cv::Mat of_right = grey(right);
    cv::merge(std::array{of_right, of_right, grey(left)}, joined);
  }
  return joined;
}

std::span<const std::string_view> depth_codings() {
  return kCodings;
}

cv::Mat coded(const cv::Mat& values, const cv::Mat& image, std::string_view coding, Span span) {
  cv::Mat numbers, bgr;
  values.convertTo(numbers, CV_32F);
  if (coding == "fog") {
    CV_Assert(image.size() == values.size() && image.type() == CV_8UC3);
    return faded(image, numbers, span);
  }
  cv::cvtColor(colour_coded(numbers, span.least, span.most), bgr, cv::COLOR_RGB2BGR);
  if (coding == "relief") shade(bgr, numbers);
  return bgr;
}

cv::Mat with_legend(const cv::Mat& bgr, std::string_view coding, Span span,
                    const std::string& unit) {
  constexpr int kMargin = 16, kBar = 22, kGap = 6, kText = 12, kLowest = 160, kMarks = 5;
  if (bgr.rows < kLowest) return bgr;
  cv::Mat whole(bgr.rows, bgr.cols + kLegendWidth, CV_8UC3, cv::Scalar::all(255));
  bgr.copyTo(whole(cv::Rect({0, 0}, bgr.size())));
  const int x = bgr.cols + kMargin, top = kMargin;
  const int bottom = bgr.rows - kMargin - 2 * kBar;
  // The scale, from the maximum at the top to the minimum.
  cv::Mat scale(bottom - top, 1, CV_32F);
  for (int y = 0; y < scale.rows; ++y)
    scale.at<float>(y) = 1 + static_cast<float>(scale.rows - 1 - y);
  const cv::Mat dark(scale.size(), CV_8UC3, cv::Scalar::all(40));  // in the fog
  const cv::Mat bar =
      coded(scale, dark, coding == "fog" ? "fog" : "colours", {1, 1.0 * scale.rows});
  cv::resize(bar, whole(cv::Rect(x, top, kBar, scale.rows)), {kBar, scale.rows}, 0, 0,
             cv::INTER_NEAREST);
  const auto write = [&](const std::string& text, int middle) {
    constexpr double kSize = 0.42;
    cv::putText(whole, text, {x + kBar + kGap, middle + kText / 3}, cv::FONT_HERSHEY_SIMPLEX, kSize,
                cv::Scalar::all(0), 1, cv::LINE_AA);
  };
  for (int i = 0; i < kMarks; ++i) {
    const double share = static_cast<double>(i) / (kMarks - 1);
    const int y = top + static_cast<int>(std::lround((1 - share) * (scale.rows - 1)));
    cv::line(whole, {x + kBar, y}, {x + kBar + 3, y}, cv::Scalar::all(0));
    write(short_number(span.least + share * (span.most - span.least), unit), y);
  }
  const cv::Rect swatch(x, bgr.rows - kMargin - kBar, kBar, kBar);
  whole(swatch).setTo(cv::Scalar::all(0));
  write("unknown", swatch.y + kBar / 2);
  return whole;
}

}  // namespace hc::vision
