// SPDX-License-Identifier: Apache-2.0
#pragma once
// What views of a board show of two cameras, and which view they lack. No messages.

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include <vision/board.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// In how many views the board was tilted, and in which parts of the images it was.
///
/// Tilted boards determine the focal lengths, and corners near the edges the lenses.
struct BoardCoverage {
  static constexpr std::size_t kParts = 9;  ///< of an image: three rows of three

  std::array<std::size_t, 4> tilts = {};       ///< with the left, right, top, bottom farther away
  std::array<std::size_t, kParts> parts = {};  ///< with corners in that part of both images

  /// What to do next with the board, such as "tilt the board to the left (the left edge in
  /// the image farther away)"; "" if nothing is missing.
  [[nodiscard]] std::string advice() const;
};

/// @param size  of the images. Tilts are estimated with a focal length of the image's width: a
///     calibration of the same views may be wrong.
BoardCoverage coverage_of(std::span<const BoardView> views, const Board& board, cv::Size size);

}  // namespace hc::vision
