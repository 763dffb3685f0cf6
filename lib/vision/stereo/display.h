// SPDX-License-Identifier: Apache-2.0
#pragma once
// Two eyes' images and depth as people look at them. Blue, green, red.

#include <span>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

namespace hc::vision {

/// The ways in which both eyes' images are shown as one.
std::span<const std::string_view> stereo_layouts();

/// Both eyes' images as one.
///
/// @param left, right  (H, W) or (H, W, 3) u8, of one size and type.
/// @param layout  one of stereo_layouts(): side_by_side (W doubled), top_bottom (H doubled),
///     red_cyan (for glasses: red of the left, green and blue of the right), rows (even rows of the
///     left, odd rows of the right: monitors with polarised rows), left, right.
cv::Mat join_eyes(const cv::Mat& left, const cv::Mat& right, std::string_view layout);

/// Shades an image as a relief that light falls on from the top left: brighter where depth falls
/// along that direction.
///
/// @param[in,out] bgr  (H, W, 3) u8. @param values  (H, W) f32; 0 unknown, which stays as it is.
void shade(cv::Mat& bgr, const cv::Mat& values);

/// An image with a scale of its colours on the right, and black as "unknown".
///
/// @param bgr  (H, W, 3) u8, of colour_coded(). @param least, most  at the ends of the scale.
/// @param unit  after the numbers, such as "m".
/// @returns  (H, W + kLegendWidth, 3) u8; the image itself where it is too low for a legend.
cv::Mat with_legend(const cv::Mat& bgr, double least, double most, const std::string& unit);

inline constexpr int kLegendWidth = 110;  ///< [px]

}  // namespace hc::vision
