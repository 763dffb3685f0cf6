// SPDX-License-Identifier: Apache-2.0
#pragma once
// The world around the simulated head: a furnished room, in the frame `world` (x forward, y left,
// z up; [m]), for a robot at the origin with its head at kHeadHeight.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <room/markers.h>
#include <room/scenery.h>

namespace hc::room {

class World {
 public:
  /// Builds the room. @param seed  of colours and positions. @param text  on the board.
  World(graphics::Renderer& renderer, std::uint64_t seed, const std::string& text);

  /// The items to draw, with the ball at a position.
  [[nodiscard]] const std::vector<graphics::Item>& items(const Eigen::Vector3d& ball);
  /// Writes one or several lines on the board, black on white.
  void write(const std::string& text);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<RoomMarker>& markers() const { return markers_; }
  [[nodiscard]] const graphics::Light& light() const { return light_; }

 private:
  void add_board();

  Scenery room_;  // the ball is its last item
  graphics::Light light_;
  std::vector<RoomMarker> markers_;
  graphics::SurfaceId board_ = 0;
  std::string text_;
};

}  // namespace hc::room
