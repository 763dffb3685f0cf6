// SPDX-License-Identifier: Apache-2.0
#pragma once
// Displays of the images of two eyes and of depth. Blue, green, red.

#include <span>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace hc::vision {

/// The layouts of join_eyes().
std::span<const std::string_view> stereo_layouts();

/// Joins the images of both eyes into one.
///
/// @param left, right  (H, W) or (H, W, 3) u8, of the same size and type.
/// @param layout  one of stereo_layouts(): side_by_side (W doubled), top_bottom (H doubled),
///     red_cyan (for glasses: red of the left, green and blue of the right), rows (even rows of the
///     left, odd rows of the right: monitors with polarised rows), left, right.
cv::Mat join_eyes(const cv::Mat& left, const cv::Mat& right, std::string_view layout);

/// Shades an image as a relief lit from the top left: brighter where depth decreases in the
/// direction of the light.
///
/// @param[in,out] bgr  (H, W, 3) u8. @param values  (H, W) f32; 0: unknown, left unchanged.
void shade(cv::Mat& bgr, const cv::Mat& values);

/// Adds a legend on the right: the colour scale, and black as "unknown".
///
/// @param bgr  (H, W, 3) u8, of colour_coded(). @param least, most  the ends of the scale.
/// @param unit  printed after the numbers, such as "m".
/// @returns  (H, W + kLegendWidth, 3) u8; the image itself if it is not high enough for a legend.
cv::Mat with_legend(const cv::Mat& bgr, double least, double most, const std::string& unit);

inline constexpr int kLegendWidth = 110;  ///< [px]

}  // namespace hc::vision
