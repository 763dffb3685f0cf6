// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rows of the simulator's tables about persons: people, hand_joints, pointed. Pure. Header
// only: a score needs no room.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hc/base/table_row.h>

#include <room/person.h>

namespace hc::room {

void place_columns(auto& p_world, auto& column) {
  column("x", "m", p_world.x());
  column("y", "m", p_world.y());
  column("z", "m", p_world.z());
}
void pixel_columns(auto& pixel, auto& column) {
  column("u", "px", pixel.x());
  column("v", "px", pixel.y());
}

/// A person, as an eye sees them. The last three are 0 behind the eye.
struct PersonRow {
  int person = 0;                                     ///< from 1
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< between the eyes [m]
  double yaw = 0;                                     ///< of the face, in the world [rad]
  bool speaks = false;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< of p_world
  double width = 0;                                 ///< of the face [px]
  double visible = 0;                               ///< share of the face, 0 … 1
};
struct PersonColumns {
  static void visit(auto& row, auto&& column) {
    column("person", "", row.person, 1.0);
    place_columns(row.p_world, column);
    column("yaw", "rad", row.yaw);
    column("speaks", "", row.speaks, 0.0, 1.0);
    pixel_columns(row.pixel, column);
    column("width", "px", row.width, 0.0);
    column("visible", "", row.visible, 0.0, 1.0);
  }
};
inline constexpr std::int32_t kPersonColumns = 10;

/// A joint of a hand; behind the eye it has the pixel (0, 0).
struct JointRow {
  int person = 0;                                     ///< from 1
  int side = 0;                                       ///< kLeft or kRight
  int joint = 0;                                      ///< 0 … 20, as MediaPipe has them
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
};
struct JointColumns {
  static void visit(auto& row, auto&& column) {
    column("person", "", row.person, 1.0);
    column("hand", "", row.side, 0.0, 1.0);
    column("joint", "", row.joint, 0.0, kHandJoints - 1.0);
    place_columns(row.p_world, column);
    pixel_columns(row.pixel, column);
  }
};
inline constexpr std::int32_t kJointColumns = 8;

/// The place at which a person points.
struct PointedRow {
  int person = 0;                                     ///< from 1
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< [m]
};
struct PointedColumns {
  static void visit(auto& row, auto&& column) {
    column("person", "", row.person, 1.0);
    place_columns(row.p_world, column);
  }
};
inline constexpr std::int32_t kPointedColumns = 4;

/// A hand, of its rows of hand_joints.
struct TrueHand {
  int person = 0, side = 0;                           ///< as in JointRow
  std::array<Eigen::Vector3d, kHandJoints> joints{};  ///< in the world [m]
  std::array<Eigen::Vector2d, kHandJoints> pixels{};
};

/// The hands that have a row for each joint in a table of hand_joints, a matrix view; by persons.
/// Invalid rows are skipped.
template <typename Rows>
std::vector<TrueHand> true_hands(const Rows& rows) {
  std::map<std::pair<int, int>, std::map<int, JointRow>> found;
  for (std::size_t i = 0; i < rows.height(); ++i)
    if (const auto joint = read_row<JointColumns, JointRow>(rows.row(i)))
      found[{joint->person, joint->side}][joint->joint] = *joint;
  std::vector<TrueHand> hands;
  for (const auto& [whose, joints] : found) {
    if (joints.size() != kHandJoints) continue;
    TrueHand& hand = hands.emplace_back(TrueHand{whose.first, whose.second});
    for (const auto& [number, joint] : joints) {
      hand.joints[static_cast<std::size_t>(number)] = joint.p_world;
      hand.pixels[static_cast<std::size_t>(number)] = joint.pixel;
    }
  }
  return hands;
}

}  // namespace hc::room
