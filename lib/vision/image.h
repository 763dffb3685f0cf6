// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images: sizes and colours. No messages; plain cv::Mat in and out.

#include <opencv2/core.hpp>

namespace hc::vision {

/// Scales an image so that it covers width × height and crops what protrudes, equally on both
/// sides. Where one of them is 0, it follows from the other; where both are, nothing changes.
///
/// @param smooth  average over the pixels (area) when shrinking; false takes the nearest pixel,
///     for images whose values must not be mixed, as disparities.
cv::Mat fit(const cv::Mat& image, int width, int height, bool smooth = true);

/// By how much fit() scales. [1]
double fit_scale(const cv::Size& size, int width, int height);

/// Red, green, blue to grey, as bright as it looks; (H, W) u8. A grey image is given as it is.
cv::Mat grey_of(const cv::Mat& image);

/// The ends of a scale of colours.
struct Span {
  double least = 0, most = 0;
};

/// The 2nd and the 98th percentile of the known values of an image, (H, W) of any scalar.
Span span_of(const cv::Mat& values);

/// An image of one channel of any depth in colours, from blue (small) over green to red (large).
///
/// @param values  (H, W) of any scalar; 0, nan and inf are unknown and become black.
/// @param least, most  the values that are bluest and reddest.
/// @returns  (H, W, 3) u8, red, green, blue.
cv::Mat colour_coded(const cv::Mat& values, double least, double most);

}  // namespace hc::vision
