// SPDX-License-Identifier: Apache-2.0
#pragma once
// The contents of a room: surfaces and their poses in the world, and random numbers.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/renderer.h>

namespace hc::room {

/// Height of the robot's head above the floor, for which the room is designed [m].
inline constexpr double kHeadHeight = 1.2;

/// Pose of a hanging image, T_world_image (x right, y down, z into it, as seen by a viewer).
///
/// @param middle  centre in the world [m].
/// @param yaw  of the direction into it, 0 being forward, > 0 to the left [rad].
Eigen::Isometry3d hang(const Eigen::Vector3d& middle, double yaw);

class Scenery {
 public:
  /// @param seed  of random().
  Scenery(graphics::Renderer& renderer, std::uint64_t seed)
      : renderer_(renderer), seed_(seed), state_(seed * 7919 + 1) {}

  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  /// The next random number, least … most. The same seed gives the same room only with the same
  /// order of calls.
  double random(double least, double most);

  /// Adds a surface at a pose T_world_surface. @param texture  (H, W, 3) u8, red, green, blue.
  void add(const graphics::Mesh& mesh, const cv::Mat& texture, const Eigen::Isometry3d& place);
  /// Adds a box, rotated about the vertical. @param size  along x, y, z [m].
  void add_box(const Eigen::Vector3d& size, const Eigen::Vector3d& middle, const cv::Mat& texture,
               double yaw = 0);
  /// The corners of all boxes, in the world [m].
  [[nodiscard]] const std::vector<std::array<Eigen::Vector3d, 8>>& boxes() const { return boxes_; }
  /// Replaces the texture of a surface.
  void set_texture(graphics::SurfaceId surface, const cv::Mat& texture) {
    renderer_.set_texture(surface, texture);
  }

  /// All surfaces, in the order added.
  [[nodiscard]] const std::vector<graphics::Item>& items() const { return items_; }
  /// Moves the surface added last.
  void move_last(const Eigen::Vector3d& middle);

 private:
  graphics::Renderer& renderer_;
  std::uint64_t seed_, state_;
  std::vector<graphics::Item> items_;
  std::vector<std::array<Eigen::Vector3d, 8>> boxes_;
};

}  // namespace hc::room
