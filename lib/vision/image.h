// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images: sizes and colours. No messages; plain cv::Mat in and out.

#include <opencv2/core.hpp>

namespace hc::vision {

/// Scales an image to cover width × height and crops the excess equally on both sides. If one of
/// them is 0, it follows from the other; if both are, nothing changes.
///
/// @param smooth  average over the area when shrinking; false takes the nearest pixel, for images
///     whose values must not be mixed, such as disparities.
cv::Mat fit(const cv::Mat& image, int width, int height, bool smooth = true);

/// The scale factor of fit() [1].
double fit_scale(const cv::Size& size, int width, int height);

/// Luminance of a red, green, blue image, (H, W) u8; a grey image is returned unchanged.
cv::Mat grey_of(const cv::Mat& image);

/// The ends of a colour scale.
struct Span {
  double least = 0, most = 0;
};

/// The 2nd and the 98th percentile of the known values of an image, (H, W) of any scalar.
Span span_of(const cv::Mat& values);

/// Colour-codes a single-channel image, from blue (small) through green to red (large).
///
/// @param values  (H, W) of any scalar; 0, nan and inf are unknown and become black.
/// @param least, most  the values at the blue and the red end.
/// @returns  (H, W, 3) u8, red, green, blue.
cv::Mat colour_coded(const cv::Mat& values, double least, double most);

}  // namespace hc::vision
