// SPDX-License-Identifier: Apache-2.0
#pragma once
// A hand in an image. Pure.

#include <array>
#include <cstddef>

#include <opencv2/core/types.hpp>

namespace hc::people {

/// A square part of an image that is turned.
struct Region {
  cv::Point2f middle;  ///< [px]
  float side = 0;      ///< [px]
  float turn = 0;  ///< of its upward direction from the image's, > 0 clockwise [rad, -π … π]
};

/// A hand, with a joint or tip at each of its points.
struct Hand {
  /// Of a finger four points follow one another, from the knuckle to the tip; those of the thumb
  /// begin at the wrist.
  enum Point {
    Wrist,
    Thumb,
    ThumbTip = Thumb + 3,
    Index,
    IndexTip = Index + 3,
    Middle,
    MiddleTip = Middle + 3,
    Ring,
    RingTip = Ring + 3,
    Little,
    LittleTip = Little + 3
  };
  static constexpr std::size_t kPoints = LittleTip + 1;
  /// The person's own.
  enum class Side { Left, Right };

  std::array<cv::Point2f, kPoints> points;  ///< [px]
  /// In the directions of the camera, x right, y down, z forward, around the hand's middle, for a
  /// hand of ordinary size. [m]
  std::array<cv::Point3f, kPoints> world;
  float presence = 0;  ///< 0 … 1: that there is a hand
  Side side = Side::Right;

  /// The smallest upright box around the points.
  [[nodiscard]] cv::Rect2f box() const;
};

/// By how much a finger is bent, from its first to its last bone, 0 for a straight one.
/// @param knuckle  Hand::Index, Middle, Ring or Little. [rad, 0 … π]
float bend(const Hand& hand, Hand::Point knuckle);

constexpr float kStraight = 1.2F;  ///< maximum bend() of a straight finger [rad]

/// Whether a hand is seen from its side, so that one finger covers another in the image.
bool is_from_side(const Hand& hand);

/// The hand with its fingers in the other order: the little finger is the index finger.
Hand with_fingers_reversed(const Hand& hand);

/// A hand that points. From its side, a network may take the index finger for the little one: if
/// that one alone is straight, the order of the fingers is reversed. Other hands are as they were.
Hand with_index_finger(const Hand& hand);

/// Where to look for the points of a hand that had these in the last image.
/// Source: MediaPipe, hand_landmark_landmarks_to_roi.pbtxt, hand_landmarks_to_rect_calculator.cc.
Region region_of(const Hand& hand);

}  // namespace hc::people
