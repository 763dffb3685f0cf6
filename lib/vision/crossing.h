// SPDX-License-Identifier: Apache-2.0
#pragma once
// Refines a crossing: a point of a board where two black and two white areas meet. Pure.

#include <opencv2/core.hpp>

namespace hc::vision {

/// Half the side of the largest square around a crossing that the next lines of the board do not
/// touch [px].
///
/// @param across, down  from the crossing to those lines, along the two that meet in it.
float room_around(cv::Point2f across, cv::Point2f down);

/// Moves a crossing to where the edges around it meet, which are sought in a window without other
/// lines. It stays where it is if they do not meet within the window.
///
/// @param grey  (H, W) u8.  @param room  of room_around().
/// @param[in,out] crossing  within the image, right to a few pixels [px].
void refine_crossing(const cv::Mat& grey, float room, cv::Point2f& crossing);

}  // namespace hc::vision
