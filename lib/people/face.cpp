// SPDX-License-Identifier: Apache-2.0
#include <people/face.h>

#include <algorithm>
#include <cmath>

namespace hc::people {

float Face::roll() const {
  const cv::Point2f across = points[LeftEye] - points[RightEye];
  return std::atan2(across.y, across.x);
}

float Face::yaw() const {
  const cv::Point2f across = points[LeftEar] - points[RightEar];
  const float width = across.dot(across);
  if (width <= 0) return 0;
  // -1 … 1: where the nose is between the ears, along their line.
  const float place = 2 * across.dot(points[Nose] - points[RightEar]) / width - 1;
  return std::asin(std::clamp(place, -1.F, 1.F));
}

}  // namespace hc::people
