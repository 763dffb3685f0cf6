// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds a blob of a colour that is set or pointed at, and logs why none is found.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <vision/blob.h>
#include <opencv2/core.hpp>

class Search {
 public:
  explicit Search(std::function<void(std::string_view)> log) : log_(std::move(log)) {}

  /// Takes the colour to search for from this pixel of the next image; it applies until the set hue
  /// changes. @param x, y  [px].
  void point(double x, double y);

  /// @param rgb  (H, W, 3) u8, the next of a sequence.
  /// @param set  the colour to search for unless one was pointed at.
  /// @param min_area  of a blob [px²].
  std::optional<hc::vision::Blob> look(const cv::Mat& rgb, const hc::vision::BlobColour& set,
                                       double min_area);

  /// "saw its target in 31 of 40 images"; empty after at most 20 images.
  [[nodiscard]] std::string summary() const;

 private:
  void take_colour(const cv::Mat& rgb, const hc::vision::BlobColour& set);
  void warn(const cv::Mat& rgb, double min_area);

  std::function<void(std::string_view)> log_;
  std::optional<hc::vision::BlobFinder> finder_;
  std::optional<cv::Point2d> pointed_;           // at the next image
  std::optional<hc::vision::BlobColour> taken_;  // from the pixel pointed at
  double hue_then_ = 0;                          // the set hue at that time
  int images_ = 0, seen_ = 0;
};
