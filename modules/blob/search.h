// SPDX-License-Identifier: Apache-2.0
#pragma once
// Looks for the blob of a colour that is set, or pointed at; and says why none is ever found.

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

  /// Searches from the next image on for the colour at this pixel of it, until the hue that is set
  /// changes. @param x, y  [px].
  void point(double x, double y);

  /// @param rgb  (H, W, 3) u8, the next of a sequence.
  /// @param set  the colour to look for while none was pointed at.
  /// @param min_area  of what counts as found [px²].
  std::optional<hc::vision::Blob> look(const cv::Mat& rgb, const hc::vision::BlobColour& set,
                                       double min_area);

  /// "saw its target in 31 of 40 images"; empty after so few that a person looks at them.
  [[nodiscard]] std::string summary() const;

 private:
  void take_colour(const cv::Mat& rgb, const hc::vision::BlobColour& set);
  void warn(const cv::Mat& rgb, double min_area);

  std::function<void(std::string_view)> log_;
  std::optional<hc::vision::BlobFinder> finder_;
  std::optional<cv::Point2d> pointed_;           // at the next image
  std::optional<hc::vision::BlobColour> taken_;  // by pointing
  double hue_then_ = 0;                          // that was set when it was taken
  int images_ = 0, seen_ = 0;
};
