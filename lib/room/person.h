// SPDX-License-Identifier: Apache-2.0
#pragma once
// A person at a moment: where the parts of the body are. Pure.

#include <array>
#include <optional>

#include <Eigen/Geometry>

#include <room/looks.h>

namespace hc::room {

/// What a hand shows.
enum class Sign { Relaxed, Open, Point, Fist, Thumb, Victory };
inline constexpr int kSigns = 6;

/// Joints of a hand: the wrist, then of the thumb, index, middle, ring and little finger four each,
/// from its root to its tip; as MediaPipe has them.
inline constexpr int kHandJoints = 21;
inline constexpr int kIndexRoot = 5, kIndexTip = 8, kFingerJoints = 4;

inline constexpr int kLeft = 0, kRight = 1;  ///< the person's own

struct Hand {
  Sign sign = Sign::Relaxed;
  /// As WebXR has it: fingers along −z, the back of the hand up along y, x to the right.
  Eigen::Isometry3d T_world_wrist = Eigen::Isometry3d::Identity();
};

struct Person {
  int number = 0;  ///< from 0; also that of the look
  /// Origin on the floor between the feet, x forward, y left, z up.
  Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
  /// Origin in the middle between the eyes, x forward, y left, z up.
  Eigen::Isometry3d T_world_face = Eigen::Isometry3d::Identity();
  std::array<Hand, 2> hands;
  double speed = 0, way = 0;  ///< of the walk [m/s], [m]
  bool speaks = false;
  std::optional<Eigen::Vector3d> pointed;  ///< the place at which the person points, in the world
};

/// Joints of a body of a look, in the body's frame [m].
Eigen::Vector3d shoulder(const Look& look, int side);
inline constexpr double kUpperArm = 0.28, kForearm = 0.26;  ///< [m]

/// +1 for the left side, −1 for the right, as y is.
inline double side_sign(int side) {
  return side == kLeft ? 1 : -1;
}

/// The pose of a wrist whose fingers and back of the hand have these directions.
Eigen::Isometry3d wrist(const Eigen::Vector3d& place, const Eigen::Vector3d& fingers,
                        const Eigen::Vector3d& back);

/// Where a hand is that hangs down, in the body's frame.
Eigen::Isometry3d hanging(const Look& look, int side);

/// Where a hand is that shows a sign to what is in front of the body, in the body's frame.
Eigen::Isometry3d shown(const Look& look, int side, Sign sign);

/// The elbow of an arm, which is bent downwards and outwards. All in one frame.
///
/// @param outwards  from the body to this side, of length 1.
Eigen::Vector3d elbow(const Eigen::Vector3d& shoulder, const Eigen::Vector3d& wrist,
                      const Eigen::Vector3d& outwards);

}  // namespace hc::room
