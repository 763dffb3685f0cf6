// SPDX-License-Identifier: Apache-2.0
#include <room/person_seen.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <room/face_shape.h>

namespace hc::room {

namespace {

using Eigen::Vector3d;

/// All points within a distance from a line [m].
struct Capsule {
  Vector3d begin, end;
  double radius;
};

/// The least distance between two lines, by turns of the nearest point on each: this converges
/// since the distance is convex.
double distance(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d ab = b - a, cd = d - c;
  auto nearest = [](const Vector3d& from, const Vector3d& along, const Vector3d& to) {
    const double length = along.squaredNorm();
    return length == 0 ? 0 : std::clamp((to - from).dot(along) / length, 0.0, 1.0);
  };
  double t = 0.5;
  Vector3d on_first, on_second;
  for (int i = 0; i < 20; ++i) {
    on_second = c + t * cd;
    on_first = a + nearest(a, ab, on_second) * ab;
    t = nearest(c, cd, on_first);
  }
  return (on_first - (c + t * cd)).norm();
}

void add_arms(std::vector<Capsule>& capsules, const Person& person) {
  for (const int side : {kLeft, kRight}) {
    const Hand& hand = person.hands[static_cast<std::size_t>(side)];
    const Vector3d top = person.T_world_body * shoulder(look_of(person.number), side);
    const Vector3d end = hand.T_world_wrist.translation();
    const Vector3d bend = elbow(top, end, side_sign(side) * person.T_world_body.linear().col(1));
    capsules.push_back({top, bend, 0.05});
    capsules.push_back({bend, end, 0.035});
    capsules.push_back({end, hand.T_world_wrist * Vector3d(0, 0, -0.13), 0.035});
  }
}

void add_trunk(std::vector<Capsule>& capsules, const Person& person) {
  const double tall = look_of(person.number).tall;
  capsules.push_back({person.T_world_face * Vector3d(-0.09, 0, 0.03),
                      person.T_world_face * Vector3d(-0.07, 0, -0.04), 0.09});
  for (const double y : {-0.09, 0.0, 0.09})
    capsules.push_back({person.T_world_body * Vector3d(0, y, tall - 0.31),
                        person.T_world_body * Vector3d(0, y, 0.4 * tall), 0.1});
}

}  // namespace

std::array<Vector3d, 25> face_points(const Person& person) {
  constexpr double kHalfHeight = 0.085, kMiddle = -0.03;  // [m]
  std::array<Vector3d, 25> points;
  std::size_t number = 0;
  // Rings of equal area, of one point and three times eight.
  points[number++] = person.T_world_face * Vector3d(0, 0, kMiddle);
  for (const double ring : {0.4, 0.68, 0.9})
    for (int ray = 0; ray < 8; ++ray) {
      const double angle = ray * 0.7854 + ring;
      points[number++] =
          person.T_world_face *
          Vector3d(-0.01, ring * kFaceWidth / 2 * look_of(person.number).wide * std::cos(angle),
                   kMiddle + ring * kHalfHeight * std::sin(angle));
    }
  return points;
}

bool is_hidden(std::span<const Person> people, std::size_t index, const Vector3d& from,
               const Vector3d& point) {
  std::vector<Capsule> capsules;
  for (std::size_t i = 0; i < people.size(); ++i) {
    add_arms(capsules, people[i]);
    if (i != index) add_trunk(capsules, people[i]);
  }
  return std::ranges::any_of(capsules, [&](const Capsule& each) {
    return distance(from, point, each.begin, each.end) < each.radius;
  });
}

}  // namespace hc::room
