// SPDX-License-Identifier: Apache-2.0
#pragma once
// Things to point at, and how an arm points. Pure.

#include <cstdint>
#include <span>

#include <Eigen/Geometry>

#include <room/person.h>

namespace hc::room {

inline constexpr double kThingRadius = 0.09;  ///< things are balls on stands [m]

/// The middles of the things, in the world [m].
std::span<const Eigen::Vector3d> things();

/// A thing at which a person may point: 1 to 3 m from the hand, and not behind the body.
///
/// @param draw  which of them, 0 … 1.
Eigen::Vector3d thing_to_point_at(const Person& person, double draw);

/// The arm that points at a place: the nearer one.
int pointing_side(const Person& person, const Eigen::Vector3d& place);

/// The wrist in the world whose stretched index finger is on the line from the eyes to a place, and
/// along it.
Eigen::Isometry3d pointing_wrist(const Person& person, int side, const Eigen::Vector3d& place);

}  // namespace hc::room
