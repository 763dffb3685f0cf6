// SPDX-License-Identifier: Apache-2.0
#pragma once
// A camera without distortion. Pure.

#include <Eigen/Core>

namespace hc::graphics {

/// Projects u = fx · x / z + cx, v = fy · y / z + cy, for a point in its optical frame (x right, y
/// down, z forward). (0, 0) is the centre of the top left pixel.
struct PinholeCamera {
  int width = 800, height = 600;   ///< [px]
  double fx = 600, fy = 600;       ///< focal lengths [px]
  double cx = 399.5, cy = 299.5;   ///< principal point [px]
  double near = 0.05, far = 50.0;  ///< clipping distances along z [m]

  /// The pixel of a point with z > 0 [px].
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_eye) const {
    return {fx * p_eye.x() / p_eye.z() + cx, fy * p_eye.y() / p_eye.z() + cy};
  }
  /// Whether a pixel is within the image.
  [[nodiscard]] bool contains(const Eigen::Vector2d& pixel) const {
    return pixel.x() > -0.5 && pixel.x() < width - 0.5 && pixel.y() > -0.5 &&
           pixel.y() < height - 0.5;
  }
};

}  // namespace hc::graphics
