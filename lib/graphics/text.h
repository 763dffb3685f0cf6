// SPDX-License-Identifier: Apache-2.0
#pragma once
// Text for textures. Pure, except for the file of the font.

#include <functional>
#include <string>

#include <opencv2/core.hpp>

namespace hc::graphics {

/// Measures and draws text in a font, with OpenCV's scale and stroke: at scale 1, capitals are 22
/// px high, without the stroke.
struct Pen {
  /// @param[out] below  of the base line [px].
  std::function<cv::Size(const std::string&, double scale, int stroke, int& below)> measure;
  /// @param image  (H, W, 3) u8. @param at  the left end of the base line [px].
  std::function<void(cv::Mat& image, const std::string&, cv::Point at, double scale, int stroke)>
      write;
};

/// A TrueType font for text that is not ASCII, if it is installed; else OpenCV's stroke font, which
/// draws "?" for other letters.
///
/// @param text  UTF-8. @param ink  colour.
Pen pen_for(const std::string& text, const cv::Scalar& ink);

}  // namespace hc::graphics
