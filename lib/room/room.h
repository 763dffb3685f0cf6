// SPDX-License-Identifier: Apache-2.0
#pragma once
// The room around the robot, and its furniture.

#include <room/scenery.h>

namespace hc::room {

inline constexpr double kRoomFront = 4.6;    ///< front wall, from the robot's axis [m]
inline constexpr double kRoomBack = -3.0;    ///< back wall [m]
inline constexpr double kRoomSide = 3.6;     ///< side walls, left and right [m]
inline constexpr double kRoomCeiling = 2.8;  ///< [m]

/// Walls with posters, floor and ceiling. @returns  the floor.
graphics::SurfaceId add_room(Scenery& room);
/// A table, a shelf with books, a stool, a chest and a round pot.
///
/// @param is_cleared  the table stands at the wall and there is no stool, so that people can walk.
void add_furniture(Scenery& room, bool is_cleared = false);
/// Balls on stands, to point at.
void add_things(Scenery& room);
/// The bench on which the ball rolls: pieces of an arc.
void add_bench(Scenery& room);
/// Paints the shadows of all boxes into the floor's texture, so they cost nothing at rendering.
void add_shadows(Scenery& room, graphics::SurfaceId floor, const Eigen::Vector3d& to_light);

}  // namespace hc::room
