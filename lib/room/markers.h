// SPDX-License-Identifier: Apache-2.0
#pragma once
// The markers in the room: ArUco, AprilTag and coloured squares.

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <room/scenery.h>

namespace hc::room {

/// A marker of the room.
struct RoomMarker {
  std::string kind;  ///< "aruco", "apriltag" or "colour"
  int id = 0;        ///< of the dictionary; of a coloured one, its hue [degree]
  double side = 0;   ///< of the black or coloured square, without the white margin [m]
  /// Optical convention: x right, y down, z into the marker, as seen by who looks at it; its
  /// middle.
  Eigen::Isometry3d T_world_marker = Eigen::Isometry3d::Identity();
};

/// Hangs them up before the robot, each of which it can see from its neck. @returns  where.
std::vector<RoomMarker> add_markers(Scenery& room);

}  // namespace hc::room
