// SPDX-License-Identifier: Apache-2.0
#pragma once
// Displays of the images of two eyes and of depth. Blue, green, red.

#include <span>
#include <string>
#include <string_view>

#include <vision/image.h>
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

/// How depth is shown by coded().
std::span<const std::string_view> depth_codings();

/// Makes depth, or another measured image, visible.
///
/// @param values  (H, W) of any scalar; 0, nan and inf are unknown and become black.
/// @param image  (H, W, 3) u8, blue, green, red; only for fog.
/// @param coding  one of depth_codings(): colours (colour_coded()), relief (the same, shaded as if
///     lit from the top left: brighter where depth decreases in the direction of the light), fog
///     (the image, faded into a light grey by distance).
/// @param span  the ends of the scale, for both eyes the same.
cv::Mat coded(const cv::Mat& values, const cv::Mat& image, std::string_view coding, Span span);

/// Adds a legend on the right: the scale of `coding`, and black as "unknown".
///
/// @param bgr  (H, W, 3) u8, of coded(). @param unit  printed after the numbers, such as "m".
/// @returns  (H, W + kLegendWidth, 3) u8; the image itself if it is not high enough for a legend.
cv::Mat with_legend(const cv::Mat& bgr, std::string_view coding, Span span,
                    const std::string& unit);

inline constexpr int kLegendWidth = 110;  ///< [px]

}  // namespace hc::vision
