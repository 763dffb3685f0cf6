// SPDX-License-Identifier: Apache-2.0
#pragma once
// Meshes of parts of a body. Pure.

#include <span>

#include <graphics/mesh.h>

namespace hc::room {

/// A cross-section of a part: an ellipse across z [m].
struct Section {
  double z, middle_x, half_x, half_y;
};

/// A closed skin around sections from top to bottom, of one colour; its image repeats each 0.3 m.
///
/// @param colour  factor of the image's red, green, blue.
graphics::Mesh make_skin(std::span<const Section> sections, const Eigen::Vector3f& colour);

/// A round limb from the origin to (0, 0, length), with round ends.
graphics::Mesh make_limb(double length, double first_radius, double last_radius,
                         const Eigen::Vector3f& colour);

}  // namespace hc::room
