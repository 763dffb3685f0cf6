// SPDX-License-Identifier: Apache-2.0
#include <room/pointing.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <room/hand_model.h>

namespace hc::room {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kReach = 0.5;  // of an arm that points, from shoulder to wrist [m]
constexpr double kNearThing = 1.0, kFarThing = 3.0;  // thing, from the hand [m]
constexpr double kBehind = 1.9;  // least angle off the front that is too far back [rad]

/// The index finger of a hand that points, in the wrist's frame: its tip, and the direction
/// from its knuckle to it.
struct Finger {
  Vector3d tip, direction;
};

Finger finger_of(int side) {
  const auto& joints = hand_joints(side, Sign::Point);
  return {joints[kIndexTip], (joints[kIndexTip] - joints[kIndexRoot]).normalized()};
}

Vector3d shoulder_in_world(const Person& person, int side) {
  return person.T_world_body * shoulder(look_of(person.number), side);
}

}  // namespace

std::span<const Vector3d> things() {
  static const std::vector<Vector3d> kAll = {
      {1.35, 0.8, 0.55}, {1.25, -0.85, 0.8}, {2.1, 2.1, 1.05}, {2.0, -2.15, 0.6}, {1.3, 0, 0.12}};
  return kAll;
}

int pointing_side(const Person& person, const Vector3d& place) {
  return (person.T_world_body.inverse() * place).y() > 0 ? kLeft : kRight;
}

Isometry3d pointing_wrist(const Person& person, int side, const Vector3d& place) {
  const Vector3d eyes = person.T_world_face.translation(), from = shoulder_in_world(person, side);
  const Vector3d ahead = (place - eyes).normalized();
  const Finger finger = finger_of(side);
  // The back of the hand is up and to the outside.
  const Vector3d out = side_sign(side) * person.T_world_body.linear().col(1);
  Isometry3d pose = wrist(Vector3d::Zero(), ahead, Vector3d::UnitZ() + 0.5 * out);
  // The fingers are not exactly along −z.
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(pose.linear() * finger.direction, ahead) * pose.linear();
  const Vector3d wrist_of_tip = -(pose.linear() * finger.tip);
  // The farthest tip on the line that the arm reaches.
  const Vector3d start = eyes + wrist_of_tip - from;
  const double b = start.dot(ahead), c = start.squaredNorm() - kReach * kReach;
  const double way = -b + std::sqrt(std::max(0.0, b * b - c));
  pose.translation() = eyes + way * ahead + wrist_of_tip;
  return pose;
}

Vector3d thing_to_point_at(const Person& person, double draw) {
  std::vector<Vector3d> possible;
  for (const auto& thing : things()) {
    const Vector3d in_body = person.T_world_body.inverse() * thing;
    const int side = pointing_side(person, thing);
    const double distance = (thing - pointing_wrist(person, side, thing).translation()).norm();
    if (std::abs(std::atan2(in_body.y(), in_body.x())) < kBehind && distance >= kNearThing &&
        distance <= kFarThing)
      possible.push_back(thing);
  }
  if (possible.empty()) return things().back();
  const auto most = possible.size() - 1;
  return possible[std::min(most, static_cast<std::size_t>(draw * static_cast<double>(most + 1)))];
}

}  // namespace hc::room
