// SPDX-License-Identifier: Apache-2.0
#pragma once
// Hands made of bones, for tests.

#include <cmath>

#include <people/hand.h>

namespace hc::people {

/// What differs between hands.
struct Pose {
  float index = 0, middle = 0, ring = 0, little = 0;  ///< bend of the fingers [rad]
  bool is_thumb_out = false;
  float turn = 0;    ///< of the whole, > 0 clockwise in the image [rad]
  float spread = 0;  ///< of the index finger from the middle one [rad]
  bool is_from_side = false;
};

/// A right hand that is upright, with its palm before the camera; 600 px per metre, around a place.
inline Hand made_hand(const Pose& pose, const cv::Point2f& middle = {400, 300}) {
  Hand hand;
  hand.presence = 1;
  auto& p = hand.world;
  const auto finger = [&](std::size_t at, float x, float bend, float spread = 0) {
    p[at] = {x, -0.02F, 0};
    float lean = 0;
    constexpr float kBones[] = {0.045F, 0.027F, 0.02F};
    for (std::size_t i = 0; i < 3; ++i) {
      p[at + i + 1] =
          p[at + i] + kBones[i] * cv::Point3f(std::cos(lean) * std::sin(spread),
                                              -std::cos(lean) * std::cos(spread), -std::sin(lean));
      lean += bend / 2;
    }
  };
  p[Hand::Wrist] = {0, 0.07F, 0};
  finger(Hand::Index, 0.02F, pose.index, pose.spread);
  finger(Hand::Middle, 0, pose.middle);
  finger(Hand::Ring, -0.02F, pose.ring);
  finger(Hand::Little, -0.04F, pose.little);
  const cv::Point3f along =
      pose.is_thumb_out ? cv::Point3f(0.03F, -0.008F, 0) : cv::Point3f(0.002F, -0.026F, -0.008F);
  for (std::size_t i = 0; i < 4; ++i)
    p[Hand::Thumb + i] = cv::Point3f(0.01F, 0.05F, 0) + along * static_cast<float>(i);
  const float cos = std::cos(pose.turn), sin = std::sin(pose.turn);
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    if (pose.is_from_side) p[i] = {p[i].z, p[i].y, -p[i].x};
    p[i] = {cos * p[i].x - sin * p[i].y, sin * p[i].x + cos * p[i].y, p[i].z};
    hand.points[i] = middle + 600 * cv::Point2f(p[i].x, p[i].y);
  }
  return hand;
}

}  // namespace hc::people
