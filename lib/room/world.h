// SPDX-License-Identifier: Apache-2.0
#pragma once
// The world around the simulated head: a furnished room, in the frame `world` (x forward, y left,
// z up; [m]), for a robot at the origin with its head at kHeadHeight.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <room/figure.h>
#include <room/markers.h>
#include <room/person.h>
#include <room/scenery.h>

namespace hc::room {

class World {
 public:
  /// Builds the room. @param seed  of colours and positions. @param text  on the board.
  /// @param people  number of persons in it. They have room to walk: the table stands at the wall,
  ///     there are things to point at, and neither stool, bench and screen nor markers, but for the
  ///     one on the wall.
  World(graphics::Renderer& renderer, std::uint64_t seed, const std::string& text, int people = 0);

  /// The items to draw, with the ball at a position, and the persons.
  [[nodiscard]] const std::vector<graphics::Item>& items(const Eigen::Vector3d& ball,
                                                         const std::vector<Person>& people = {});
  /// Writes one or several lines on the board, black on white.
  void write(const std::string& text);

  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<RoomMarker>& markers() const { return markers_; }
  [[nodiscard]] const graphics::Light& light() const { return light_; }
  /// The corners of the furniture's boxes, in the world [m].
  [[nodiscard]] const std::vector<std::array<Eigen::Vector3d, 8>>& boxes() const {
    return room_.boxes();
  }

 private:
  void add_board(double x);

  Scenery room_;  // the ball is its last item
  std::vector<Figure> figures_;
  std::vector<graphics::Item> items_;  // of the room and the figures
  graphics::Light light_;
  std::vector<RoomMarker> markers_;
  graphics::SurfaceId board_ = 0;
  std::string text_;
};

}  // namespace hc::room
