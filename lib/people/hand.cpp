// SPDX-License-Identifier: Apache-2.0
#include <people/hand.h>

#include <algorithm>
#include <cmath>

namespace hc::people {

cv::Rect2f Hand::box() const {
  cv::Point2f least = points[0], most = points[0];
  for (const auto& point : points) {
    least = {std::min(least.x, point.x), std::min(least.y, point.y)};
    most = {std::max(most.x, point.x), std::max(most.y, point.y)};
  }
  return {least, most};
}

Region region_of(const Hand& hand) {
  constexpr float kLarger = 2.0F, kAhead = 0.1F;
  // What moves least while fingers bend.
  constexpr int kPalm[] = {0, 1, 2, 3, 5, 6, 9, 10, 13, 14, 17, 18};
  const auto& p = hand.points;
  const cv::Point2f knuckles =
      ((p[Hand::Index] + p[Hand::Ring]) / 2 + p[Hand::Middle]) / 2 - p[Hand::Wrist];
  const float turn = std::atan2(knuckles.x, -knuckles.y);
  const cv::Point2f right(std::cos(turn), std::sin(turn)), down(-right.y, right.x);
  cv::Point2f least(INFINITY, INFINITY), most = -least;
  for (const int i : kPalm) {
    const auto& point = p[static_cast<std::size_t>(i)];
    const cv::Point2f turned(point.dot(right), point.dot(down));
    least = {std::min(least.x, turned.x), std::min(least.y, turned.y)};
    most = {std::max(most.x, turned.x), std::max(most.y, turned.y)};
  }
  const cv::Point2f size = most - least;
  cv::Point2f middle = (least + most) / 2;
  middle.y -= kAhead * size.y;
  return {right * middle.x + down * middle.y, kLarger * std::max(size.x, size.y), turn};
}

}  // namespace hc::people
