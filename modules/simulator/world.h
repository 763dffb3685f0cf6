// SPDX-License-Identifier: Apache-2.0
#pragma once
// The world around the simulated head: a furnished room, in the frame `world` (x forward, y left,
// z up; [m]). The robot's axis stands in the origin, the pan-tilt unit's axes meet kNeckHeight
// above.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/renderer.h>

inline constexpr double kNeckHeight = 1.2;  ///< [m]

/// A plate or coloured marker of the room.
struct Plate {
  std::string kind;  ///< "aruco", "apriltag" or "colour"
  int id = 0;        ///< of the dictionary; of a coloured one, its hue [degree]
  double side = 0;   ///< of the black or coloured square, without the white margin [m]
  /// Optical convention: x right, y down, z into the plate, as seen by who looks at it; its middle.
  Eigen::Isometry3d T_world_plate = Eigen::Isometry3d::Identity();
};

class World {
 public:
  /// Builds the room. @param seed  of colours, and of where things stand. @param text  on the
  /// board.
  World(hc::graphics::Renderer& renderer, std::uint64_t seed, const std::string& text);

  /// What is to be drawn, the ball being there.
  [[nodiscard]] const std::vector<hc::graphics::Item>& items(const Eigen::Vector3d& ball);
  /// Writes on the board, black on white: a line, or several.
  void write(const std::string& text);

  /// How much of the ball is seen from a place, with nothing but the screen between. [0 … 1]
  [[nodiscard]] double share_seen(const Eigen::Vector3d& ball, const Eigen::Vector3d& from) const;

  [[nodiscard]] const std::vector<Plate>& plates() const { return plates_; }
  /// The middle of the board.
  [[nodiscard]] const Eigen::Vector3d& board() const { return board_place_; }
  [[nodiscard]] const hc::graphics::Light& light() const { return light_; }

 private:
  double random(double least, double most);
  void add(const hc::graphics::Mesh& mesh, const cv::Mat& texture, const Eigen::Isometry3d& place);
  void add_box(const Eigen::Vector3d& size, const Eigen::Vector3d& middle, const cv::Mat& texture,
               double yaw = 0);
  void add_room();
  void add_furniture();
  void add_arc();
  void add_plates();

  hc::graphics::Renderer& renderer_;
  std::uint64_t seed_, state_;
  std::vector<hc::graphics::Item> items_;  // the ball is the last
  std::vector<Plate> plates_;
  hc::graphics::SurfaceId board_ = 0;
  Eigen::Vector3d board_place_ = Eigen::Vector3d::Zero();
  Eigen::Isometry3d T_world_screen_ = Eigen::Isometry3d::Identity();
  hc::graphics::Light light_;
};
