// SPDX-License-Identifier: Apache-2.0
#pragma once
// Boxes in images. Pure.

#include <vector>

#include <opencv2/core/types.hpp>

namespace hc::people {

/// Area of the intersection of two boxes, divided by that of their union. 0 … 1
inline float overlap(const cv::Rect2f& a, const cv::Rect2f& b) {
  const float both = (a & b).area(), all = a.area() + b.area() - both;
  return all > 0 ? both / all : 0;
}

/// Parts that cover an image, each as high or as wide as it, and overlapping by nearly a quarter or
/// more. Those of a strip are larger, at most twelve, and extend beyond it. The whole image, if it
/// has nearly the shape of a part.
/// @param shape  of a part: its width and height, in any unit.
std::vector<cv::Rect> parts_of(const cv::Size& image, const cv::Size& shape = {1, 1});

}  // namespace hc::people
