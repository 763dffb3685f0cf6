// SPDX-License-Identifier: Apache-2.0
#include "search.h"

#include <cmath>

#include <hc/base/format.h>

void Search::point(double x, double y) {
  constexpr double kFar = 1e6;
  if (!(std::abs(x) < kFar) || !(std::abs(y) < kFar)) return log_("point: outside the image");
  pointed_ = {x, y};
}

void Search::take_colour(const cv::Mat& rgb, const hc::vision::BlobColour& set) {
  const cv::Point at(static_cast<int>(std::lround(pointed_->x)),
                     static_cast<int>(std::lround(pointed_->y)));
  pointed_.reset();
  if (!cv::Rect(0, 0, rgb.cols, rgb.rows).contains(at)) return log_("point: outside the image");
  auto colour = hc::vision::colour_at(rgb, at);
  if (!colour) return log_(hc::format("point: no colour at {}, {}", at.x, at.y));
  colour->hue_width = set.hue_width;
  taken_ = colour;
  hue_then_ = set.hue;
  log_(hc::format("point: hue {:.3f}, saturation {:.2f} and value {:.2f} at least", colour->hue,
                  colour->min_saturation, colour->min_value));
}

std::optional<hc::vision::Blob> Search::look(const cv::Mat& rgb, const hc::vision::BlobColour& set,
                                             double min_area) {
  if (pointed_) take_colour(rgb, set);
  if (taken_ && set.hue != hue_then_) taken_.reset();
  const auto colour = taken_.value_or(set);
  if (!finder_ || !(finder_->colour() == colour)) finder_.emplace(colour);
  const auto blob = finder_->find(rgb, min_area);
  ++images_;
  seen_ += blob ? 1 : 0;
  if (seen_ == 0) warn(rgb, min_area);
  return blob;
}

// If the colour is found, but too pale or too dark: logs which limits it misses.
void Search::warn(const cv::Mat& rgb, double min_area) {
  constexpr int kMany = 40;
  if (images_ != kMany) return;
  const auto faint = finder_->find_faint(rgb, min_area);
  if (!faint) return;
  const auto& wanted = finder_->colour();
  log_(hc::format(
      "no blob in {} images: pixels of hue {:.2f} have a mean saturation of {:.2f} and a mean "
      "value of {:.2f}, below the minimum of {:.2f} and {:.2f}; raise the camera's exposure, or "
      "lower the parameters saturation or value",
      kMany, wanted.hue, faint->min_saturation, faint->min_value, wanted.min_saturation,
      wanted.min_value));
}

std::string Search::summary() const {
  constexpr int kFew = 20;
  if (images_ <= kFew) return {};
  return hc::format("saw its target in {} of {} images", seen_, images_);
}
