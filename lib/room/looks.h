// SPDX-License-Identifier: Apache-2.0
#pragma once
// The looks of the persons in the room: how each differs from the photograph of which all faces
// are made. Pure.

#include <vector>

#include <Eigen/Core>

namespace hc::room {

/// Enlarges and moves a part of a face, on both sides alike. Places are as seen from the front, in
/// metres from the middle between the eyes: y to the person's left, z up.
struct Warp {
  Eigen::Vector2d middle;            ///< in the photograph, y ≥ 0 [m]
  double radius;                     ///< of its influence, which is a Gaussian [m]
  Eigen::Vector2d enlarge = {1, 1};  ///< along y and z
  Eigen::Vector2d move = {0, 0};     ///< y > 0 is away from the middle of the face [m]
};

/// A change of colours: of a pixel's brightness (0 … 1) to a power, and its colour.
struct Dye {
  double strength = 0;              ///< 0: as photographed; 1: only this colour
  double gamma = 1;                 ///< of the brightness
  Eigen::Vector3d rgb = {1, 1, 1};  ///< 0 … 1 of the brightness
};

struct Look {
  double wide = 1, high = 1;  ///< of the head, relative to the photograph's
  double jaw = 1;             ///< width of the lower face, relative to the head's
  std::vector<Warp> warps;    ///< in turn
  Dye skin, hair;
  double beard = 0, brows = 0;  ///< darkness, 0 … 1
  bool glasses = false;
  Eigen::Vector3d clothes, trousers;  ///< red, green, blue [of 255]
  double tall = 1.7;                  ///< from the floor to the eyes [m]
  double pitch = 120;                 ///< of the voice [Hz]
};

inline constexpr int kMostPeople = 3;

/// @param person  from 0, below kMostPeople.
const Look& look_of(int person);

}  // namespace hc::room
