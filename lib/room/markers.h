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
  int id = 0;        ///< in the dictionary; for colour the hue [degree]
  double side = 0;   ///< of the black or coloured square without the margin [m]
  /// Origin in the centre; x right, y down, z into the marker, as seen by a viewer.
  Eigen::Isometry3d T_world_marker = Eigen::Isometry3d::Identity();
};

/// Adds markers in front of the robot, all visible from its neck. @returns  their poses.
///
/// @param only_on_wall  without those that stand or hang in the room.
std::vector<RoomMarker> add_markers(Scenery& room, bool only_on_wall = false);

}  // namespace hc::room
