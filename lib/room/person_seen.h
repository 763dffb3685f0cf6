// SPDX-License-Identifier: Apache-2.0
#pragma once
// How much of a person's face is seen, with other persons and hands before it. Pure.

#include <span>

#include <room/person.h>

namespace hc::room {

/// The share of points of a face for which this is true: that nobody is before them, and
/// `is_in_view` of the point [0 … 1].
///
/// @param people  all persons, with the one of the face. @param index  of that one.
/// @param from  position of the eye that sees it, in the world [m].
template <typename IsInView>
double face_seen(std::span<const Person> people, std::size_t index, const Eigen::Vector3d& from,
                 IsInView is_in_view);

/// Points of a face, in the world [m].
std::array<Eigen::Vector3d, 25> face_points(const Person& person);

/// Whether something of the persons is before a point of one's face.
bool is_hidden(std::span<const Person> people, std::size_t index, const Eigen::Vector3d& from,
               const Eigen::Vector3d& point);

template <typename IsInView>
double face_seen(std::span<const Person> people, std::size_t index, const Eigen::Vector3d& from,
                 IsInView is_in_view) {
  const auto points = face_points(people[index]);
  int seen = 0;
  for (const auto& point : points)
    seen += is_in_view(point) && !is_hidden(people, index, from, point);
  return static_cast<double>(seen) / static_cast<double>(points.size());
}

}  // namespace hc::room
