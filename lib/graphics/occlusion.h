// SPDX-License-Identifier: Apache-2.0
#pragma once
// How near the scene is in the images of two eyes, by the depth of the left one. Pure.
//
// Nearness is disparity, focal length · baseline / depth [px]: what is measured has the same error
// in it everywhere. The pair is rectified: the right eye sees a point so many pixels further left.

#include <opencv2/core.hpp>

namespace hc::graphics {

/// The nearness of all that a part of the left or the right image shows. Where depth is unknown, it
/// is that of the nearest known pixels to the left and right in the row, of the farther one: what
/// only one eye sees belongs to what is behind. 0 in a row without any. What the left eye does not
/// see is unknown in the right one, too.
///
/// @param depth  (H, W) f32 of the left image [m]; 0 where unknown.
/// @param scale  focal length · baseline [px · m].
/// @param part  of the image [px].
/// @param[out] nearness  (H, W) f32 of the part [px].
/// Cost: linear in the rows' pixels; all cores.
void nearness_of(bool is_right, const cv::Mat& depth, double scale, const cv::Rect& part,
                 cv::Mat& nearness);

}  // namespace hc::graphics
