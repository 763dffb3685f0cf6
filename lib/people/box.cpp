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
  if (!(beyond > kNearly)) return {cv::Rect({}, image)};    // also of an empty image
  const cv::Size part(std::max(1, cvRound(scale * shape.width)),
                      std::max(1, cvRound(scale * shape.height)));
  const int last = cvCeil((beyond - kNearly) / kStep);
  const bool is_wide = right > down;
  const int way = is_wide ? image.width - part.width : image.height - part.height;
  std::vector<cv::Rect> parts;
  for (int i = 0; i <= last; ++i)
    parts.emplace_back(is_wide ? cv::Point(way * i / last, 0) : cv::Point(0, way * i / last), part);
  return parts;
}

}  // namespace hc::people
