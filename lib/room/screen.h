// SPDX-License-Identifier: Apache-2.0
#pragma once
// The screen behind which the ball hides.

#include <Eigen/Geometry>

#include <room/scenery.h>

namespace hc::room {

/// The share of the ball that the screen does not hide [0 … 1]. Pure.
///
/// @param ball  its centre in the world [m]. @param from  position of the eye in the world [m].
double share_seen(const Eigen::Vector3d& ball, const Eigen::Vector3d& from);

/// Adds the screen with its foot in front of the ball's arc.
void add_screen(Scenery& room);

}  // namespace hc::room
