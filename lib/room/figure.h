// SPDX-License-Identifier: Apache-2.0
#pragma once
// Draws a person: a head, a trunk, and limbs.

#include <array>
#include <vector>

#include <graphics/renderer.h>

#include <room/person.h>

namespace hc::room {

class Figure {
 public:
  /// @param person  its number.
  Figure(graphics::Renderer& renderer, int person);

  /// Adds the items of the person at a moment.
  void add_to(std::vector<graphics::Item>& items, const Person& person) const;

 private:
  graphics::SurfaceId head_, trunk_, upper_arm_, forearm_, thigh_, shin_;
  std::array<std::array<graphics::SurfaceId, kSigns>, 2> hands_;  // left and right
};

/// The joints of a leg in the body's frame [m].
struct Leg {
  Eigen::Vector3d hip, knee, ankle;
};

/// A leg of a person who stands or walks.
Leg leg_of(const Person& person, int side);

}  // namespace hc::room
