// SPDX-License-Identifier: Apache-2.0
#pragma once
// Surfaces that bones move, such as a hand's. Pure.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/mesh.h>
#include <hc/base/result.h>

namespace hc::graphics {

struct Bone {
  std::string name;
  Eigen::Isometry3f T_mesh_bone;  ///< at rest
};

/// The bones that move a vertex, and the share of each; the shares sum up to 1.
struct Hold {
  std::array<std::uint32_t, 4> bones = {};
  std::array<float, 4> shares = {};
};

struct Skin {
  Mesh mesh;  ///< at rest
  std::vector<Bone> bones;
  std::vector<Hold> holds;  ///< of each vertex
};

/// Reads the first surface with bones of a binary glTF file (.glb). Its scale is 1.
///
/// Errors: Malformed (from assimp; no such surface; a bone that is stretched).
Result<Skin> read_skin(std::span<const std::byte> glb);

/// The surface with its bones at other poses.
///
/// @param T_mesh_bone  of each, in the order of the bones.
/// Source: linear blend skinning; Magnenat-Thalmann et al., 1988.
Mesh posed(const Skin& skin, std::span<const Eigen::Isometry3f> T_mesh_bone);

}  // namespace hc::graphics
