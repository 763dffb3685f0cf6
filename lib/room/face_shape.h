// SPDX-License-Identifier: Apache-2.0
#pragma once
// The shape of a person's head. Its frame: origin in the middle between the eyes, x forward, y to
// the person's left, z up. Pure.

#include <graphics/mesh.h>

#include <room/looks.h>

namespace hc::room {

/// Places on the surface are given as on a globe that faces forward with longitude 0: `round` is
/// the longitude, > 0 to the left, and z the height before it is stretched by a look.
inline constexpr double kHeadTop = 0.126, kHeadBottom = -0.113;  ///< [m]
inline constexpr double kFaceWidth = 0.13;                       ///< of a face with wide = 1 [m]

/// Half of the head's width at a height, with the hair [m].
double half_width(double z);

/// The mesh; its image is that of paint_head().
graphics::Mesh make_head(const Look& look);

}  // namespace hc::room
