// SPDX-License-Identifier: Apache-2.0
#pragma once
// Nearness of the scene in the images of two eyes, from the depth of the left one. Pure.
//
// Nearness is disparity, focal length · baseline / depth [px], whose error is the same everywhere.
// The pair is rectified: in the right image a point is that many pixels further left.

#include <opencv2/core.hpp>

namespace hc::graphics {

/// The nearness in a part of the left or right image. Unknown pixels take the smaller nearness of
/// the nearest known pixels left and right in the row, since surfaces visible to one eye only
/// belong to the background; 0 in a row without known pixels. Surfaces hidden from the left eye are
/// unknown in the right image, too.
///
/// @param depth  (H, W) f32 of the left image [m]; 0 where unknown.
/// @param scale  focal length · baseline [px · m].
/// @param part  of the image [px].
/// @param[out] nearness  (H, W) f32 of the part [px].
/// Cost: linear in the rows' pixels; all cores.
void nearness_of(bool is_right, const cv::Mat& depth, double scale, const cv::Rect& part,
                 cv::Mat& nearness);

}  // namespace hc::graphics
