// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the markers of a board are. Pure.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <vision/board.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// A marker on a board.
struct BoardMarker {
  /// Top left, top right, bottom right, bottom left, as Board::corners() [m].
  std::array<cv::Point2f, 4> corners;
  /// The corner of the board that is nearest to each, if any, in Board::corners().
  std::array<std::optional<std::size_t>, 4> nearest;
};

/// The markers by their id. None of a chessboard.
///
/// @param is_legacy  of a ChArUco board with an even number of rows: as OpenCV before 4.6 drew it,
///     with a white square at the top left. Others have always had a black one there.
std::vector<BoardMarker> layout_of(const Board& board, bool is_legacy = false);

}  // namespace hc::vision
