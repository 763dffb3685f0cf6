// SPDX-License-Identifier: Apache-2.0
#include <people/box.h>

#include <algorithm>
#include <cmath>

namespace hc::people {

std::vector<cv::Rect> parts_of(const cv::Size& image, const cv::Size& shape) {
  constexpr int kMostParts = 8;  // beside one another without overlap: an image may be a strip
  constexpr double kStep = 0.75, kNearly = 0.02;  // of a part
  const double right = 1.0 * image.width / shape.width, down = 1.0 * image.height / shape.height;
  const double scale = std::max(std::min(right, down), std::max(right, down) / kMostParts);
  const double beyond = std::max(right, down) / scale - 1;  // parts
  if (!(beyond > kNearly)) return {cv::Rect({}, image)};
  const cv::Size part(std::max(1, cvRound(scale * shape.width)),
                      std::max(1, cvRound(scale * shape.height)));
  const int count = 1 + cvCeil((beyond - kNearly) / kStep);
  std::vector<cv::Rect> parts;
  for (int i = 0; i < count; ++i) {
    const auto at = [&](int length, int side) { return (length - side) * i / (count - 1); };
    const cv::Point begin = right > down ? cv::Point(at(image.width, part.width), 0)
                                         : cv::Point(0, at(image.height, part.height));
    parts.emplace_back(begin, part);
  }
  return parts;
}

}  // namespace hc::people
