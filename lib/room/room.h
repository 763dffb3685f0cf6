// SPDX-License-Identifier: Apache-2.0
#pragma once
// The room about the robot, and its furniture.

#include <room/scenery.h>

namespace hc::room {

inline constexpr double kRoomFront = 4.6;    ///< the wall before the robot, from its axis [m]
inline constexpr double kRoomBack = -3.0;    ///< the wall behind it [m]
inline constexpr double kRoomSide = 3.6;     ///< the walls beside it, to either side [m]
inline constexpr double kRoomCeiling = 2.8;  ///< [m]

/// Walls with posters, floor and ceiling. @returns  the floor.
graphics::SurfaceId add_room(Scenery& room);
/// A table, a shelf with books, a stool, a chest and a round pot.
void add_furniture(Scenery& room);
/// The bench that the ball rolls on: pieces of an arc.
void add_bench(Scenery& room);
/// Paints the shadows of all boxes on the floor: no work when it is drawn.
void add_shadows(Scenery& room, graphics::SurfaceId floor, const Eigen::Vector3d& to_light);

}  // namespace hc::room
