// SPDX-License-Identifier: Apache-2.0
#pragma once
// Surfaces of triangles, and those of simple bodies. Pure.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace hc::graphics {

/// A corner of triangles.
struct Vertex {
  Eigen::Vector3f position;                           ///< object's frame [m]
  Eigen::Vector3f normal;                             ///< outwards, of length 1
  Eigen::Vector2f texture = Eigen::Vector2f::Zero();  ///< 0 … 1 over the image, row 0 on top
};

/// Triangles, three indices each, counter-clockwise as seen from outside.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> indices;

  /// Adds another's triangles.
  void append(const Mesh& other);
};

/// A rectangle in the plane z = 0, its middle in the origin, seen from where z < 0 with x to the
/// right and y down: so as an image is seen by the camera that takes it (x right, y down,
/// z forward).
///
/// @param width, height  along x and y [m].
/// @param repeat  how often its image is repeated along x and y.
Mesh make_rectangle(float width, float height,
                    const Eigen::Vector2f& repeat = Eigen::Vector2f::Ones());

/// A box, its middle in the origin. Each side has the whole image.
///
/// @param size  along x, y and z [m].
Mesh make_box(const Eigen::Vector3f& size);

/// A ball, its middle in the origin; the image goes round it once, from pole to pole along z.
///
/// @param radius  [m].
/// @param rings  between the poles, at least 2; twice as many corners on each.
Mesh make_ball(float radius, int rings = 24);

}  // namespace hc::graphics
