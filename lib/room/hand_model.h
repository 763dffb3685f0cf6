// SPDX-License-Identifier: Apache-2.0
#pragma once
// The shape of a hand that shows a sign. In the wrist's frame: fingers along −z, the back of the
// hand up along y, x to the right. Pure.

#include <array>

#include <Eigen/Geometry>

#include <graphics/mesh.h>

#include <room/person.h>

namespace hc::room {

/// The joints [m]. @param side  kLeft or kRight.
const std::array<Eigen::Vector3d, kHandJoints>& hand_joints(int side, Sign sign);

/// The surface, with texture coordinates.
const graphics::Mesh& hand_mesh(int side, Sign sign);

}  // namespace hc::room
