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

/// Squares that cover an image, each as high or as wide as it, and overlapping by a quarter or
/// more.
std::vector<cv::Rect> parts_of(const cv::Size& image);

}  // namespace hc::people
