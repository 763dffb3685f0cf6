// SPDX-License-Identifier: Apache-2.0
#include <people/box.h>

#include <algorithm>
#include <cmath>

namespace hc::people {

std::vector<cv::Rect> parts_of(const cv::Size& image) {
  const int length = std::max(image.width, image.height);
  constexpr int kMostSides = 8;  // in a length: an image may be a strip
  const int side = std::max({std::min(image.width, image.height), length / kMostSides, 1});
  constexpr double kStep = 0.75;  // of a side
  const int count = 1 + static_cast<int>(std::ceil((length - side) / (kStep * side)));
  std::vector<cv::Rect> parts;
  for (int i = 0; i < count; ++i) {
    const int at = count == 1 ? 0 : (length - side) * i / (count - 1);
    parts.push_back(image.width >= image.height ? cv::Rect(at, 0, side, side)
                                                : cv::Rect(0, at, side, side));
  }
  return parts;
}

}  // namespace hc::people
