// SPDX-License-Identifier: Apache-2.0
#pragma once
// Triangle meshes, and those of simple bodies. Pure.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace hc::graphics {

struct Vertex {
  Eigen::Vector3f position;                           ///< object's frame [m]
  Eigen::Vector3f normal;                             ///< outwards, of length 1
  Eigen::Vector2f texture = Eigen::Vector2f::Zero();  ///< 0 … 1 over the image, row 0 at the top
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();   ///< factor of the image's red, green, blue
};

/// Triangles of three indices each, counter-clockwise as seen from outside.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;

  /// Adds another's triangles.
  void append(const Mesh& other);
};

/// A rectangle in the plane z = 0, centred at the origin, visible from z < 0 with x right and y
/// down, as in a camera's optical frame.
///
/// @param width, height  along x and y [m].
/// @param repeat  repetitions of its image along x and y.
Mesh make_rectangle(float width, float height,
                    const Eigen::Vector2f& repeat = Eigen::Vector2f::Ones());

/// A box centred at the origin. Each side has the whole image.
///
/// @param size  along x, y and z [m].
Mesh make_box(const Eigen::Vector3f& size);

/// A ball centred at the origin; the image wraps around it once, with the poles along z.
///
/// @param radius  [m].
/// @param rings  between the poles, at least 2; with twice as many vertices each.
Mesh make_ball(float radius, int rings = 24);

/// A coarser mesh: all vertices in a cell of a grid become one, which is their mean.
///
/// @param cell  side of the cells [m].
/// Source: Rossignac, Borrel: Multi-resolution 3D approximations for rendering complex scenes,
/// 1993.
Mesh make_coarse(const Mesh& mesh, float cell);

}  // namespace hc::graphics
