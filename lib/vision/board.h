// SPDX-License-Identifier: Apache-2.0
#pragma once
// A chessboard, and its corners in the images of two cameras. No messages; plain cv::Mat in.

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// A chessboard by its inner corners; columns and rows must differ.
struct Board {
  int columns = 9, rows = 6;  ///< inner corners in a row, in a column
  double square = 0.025;      ///< side of a square [m]

  /// The corners, row by row, on the board: x right, y down, the first one is the origin [m].
  [[nodiscard]] std::vector<cv::Point3f> corners() const;
};

/// A board's corners in both images, in the same order, row by row [px].
struct BoardView {
  std::vector<cv::Point2f> left, right;
};

/// Finds the board in both images. It must be complete, with a white margin.
///
/// @param left, right  (H, W) or (H, W, 3) u8, red, green, blue.
/// Cost: 50 to 200 ms with a board, and at most as much without, whatever the images show.
/// Source: Duda and Frese, Accurate Detection and Localization of Checkerboard Corners for
/// Calibration, 2018 (as in OpenCV).
std::optional<BoardView> find_board(const cv::Mat& left, const cv::Mat& right, const Board& board);

/// Moves a board's corners to where the edges around them meet.
///
/// Each corner is sought in a window in which there is no other line of the board, however it is
/// tilted.
/// @param grey  (H, W) u8.  @param[in,out] corners  row by row [px], right to a few pixels.
void refine_board(const cv::Mat& grey, const Board& board, std::vector<cv::Point2f>& corners);

/// The difference of two views: the mean distance of their corners [px].
double difference(const BoardView& a, const BoardView& b);

}  // namespace hc::vision
