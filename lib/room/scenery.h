// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a room is furnished with: surfaces at their places in the world, and dice for the rest.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/renderer.h>

namespace hc::room {

/// How high above the floor the robot's head is for whom the room is furnished [m].
inline constexpr double kHeadHeight = 1.2;

/// Where an image hangs, T_world_image (x right, y down, z into it, of who looks at it).
///
/// @param middle  in the world [m].
/// @param yaw  of the direction into it, 0 being forward, > 0 to the left [rad].
Eigen::Isometry3d hang(const Eigen::Vector3d& middle, double yaw);

class Scenery {
 public:
  /// @param seed  of the dice.
  Scenery(graphics::Renderer& renderer, std::uint64_t seed)
      : renderer_(renderer), seed_(seed), state_(seed * 7919 + 1) {}

  [[nodiscard]] std::uint64_t seed() const { return seed_; }
  /// The next throw, least … most. The order of throws is part of the world: the same seed gives
  /// the same room.
  double random(double least, double most);

  /// Puts a surface somewhere, T_world_surface. @param texture  (H, W, 3) u8, red, green, blue.
  void add(const graphics::Mesh& mesh, const cv::Mat& texture, const Eigen::Isometry3d& place);
  /// Puts a box somewhere, turned about the vertical. @param size  along x, y, z [m].
  void add_box(const Eigen::Vector3d& size, const Eigen::Vector3d& middle, const cv::Mat& texture,
               double yaw = 0);
  /// The corners of all boxes, in the world [m].
  [[nodiscard]] const std::vector<std::array<Eigen::Vector3d, 8>>& boxes() const { return boxes_; }
  /// Puts another image on a surface.
  void set_texture(graphics::SurfaceId surface, const cv::Mat& texture) {
    renderer_.set_texture(surface, texture);
  }

  /// All that was put, in that order.
  [[nodiscard]] const std::vector<graphics::Item>& items() const { return items_; }
  /// Moves what was put last.
  void move_last(const Eigen::Vector3d& middle);

 private:
  graphics::Renderer& renderer_;
  std::uint64_t seed_, state_;
  std::vector<graphics::Item> items_;
  std::vector<std::array<Eigen::Vector3d, 8>> boxes_;
};

}  // namespace hc::room
