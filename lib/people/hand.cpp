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

float bend(const Hand& hand, Hand::Point knuckle) {
  const auto& p = hand.world;
  const auto at = static_cast<std::size_t>(knuckle);
  const auto first = p[at + 1] - p[at], last = p[at + 3] - p[at + 2];
  return std::atan2(static_cast<float>(cv::norm(first.cross(last))), first.dot(last));
}

bool is_from_side(const Hand& hand) {
  constexpr double kNear = 0.25;  // of the palm's length; 0.67 from the front
  const auto& p = hand.points;
  return cv::norm(p[Hand::Index] - p[Hand::Little]) <
         kNear * cv::norm(p[Hand::Middle] - p[Hand::Wrist]);
}

Hand with_fingers_reversed(const Hand& hand) {
  constexpr std::size_t kFinger = Hand::Middle - Hand::Index, kLast = Hand::Index + Hand::Little;
  Hand reversed = hand;
  for (std::size_t from = Hand::Index; from <= Hand::Little; from += kFinger)
    for (std::size_t i = 0; i < kFinger; ++i) {
      reversed.points[kLast - from + i] = hand.points[from + i];
      reversed.world[kLast - from + i] = hand.world[from + i];
    }
  return reversed;
}

Hand with_index_finger(const Hand& hand) {
  const auto is_straight = [&](Hand::Point knuckle) { return bend(hand, knuckle) < kStraight; };
  const bool is_little = is_from_side(hand) && is_straight(Hand::Little) &&
                         !is_straight(Hand::Index) && !is_straight(Hand::Middle) &&
                         !is_straight(Hand::Ring);
  return is_little ? with_fingers_reversed(hand) : hand;
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
