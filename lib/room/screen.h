// SPDX-License-Identifier: Apache-2.0
#pragma once
// The screen that the ball hides behind. Pure, but for what is drawn.

#include <Eigen/Geometry>

#include <room/scenery.h>

namespace hc::room {

/// How much of the ball is seen past the screen. [0 … 1]
///
/// @param ball  its middle, in the world [m]. @param from  where the eye is, in the world [m].
double share_seen(const Eigen::Vector3d& ball, const Eigen::Vector3d& from);

/// Puts the screen before the arc on which the ball rolls, with its foot.
void add_screen(Scenery& room);

}  // namespace hc::room
