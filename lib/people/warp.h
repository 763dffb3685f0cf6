// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parts of images, moved and turned. Pure.

#include <opencv2/core/mat.hpp>

namespace hc::people {

/// A square part of an image, as cv::warpAffine() with interpolation gives it, also of an image
/// that is larger than that function takes; a part longer than 32766 px is thinned first.
/// @param image  u8, not empty. @param to_image  of the result's pixels, finite.
/// @param side  of the result [px]. @param border  cv::BORDER_CONSTANT or BORDER_REPLICATE.
cv::Mat warped(const cv::Mat& image, cv::Matx23d to_image, int side, int border);

}  // namespace hc::people
