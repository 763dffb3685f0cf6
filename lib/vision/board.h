// SPDX-License-Identifier: Apache-2.0
#pragma once
// A calibration board, and its corners in the images of two cameras. No messages; plain cv::Mat in.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::vision {

enum class BoardKind { Chessboard, Charuco, AprilGrid };

/// A flat pattern whose corners are known.
///
/// A ChArUco board is a chessboard with ArUco markers in its white squares, as OpenCV draws it. An
/// AprilGrid is a grid of AprilTags (36h11) with a black square at each of their corners, as Kalibr
/// draws it: tag 0 is at the lower left, tag 1 to its right.
struct Board {
  /// Inner corners of a chessboard, squares of a ChArUco board, tags of an AprilGrid.
  int columns = 9, rows = 6;
  double square = 0.025;  ///< side of a square [m]; not of an AprilGrid
  BoardKind kind = BoardKind::Chessboard;
  double marker = 0;   ///< side of a marker or tag [m]
  double spacing = 0;  ///< between two tags, relative to their side

  /// The corners on the board: x right, y down, the first one is the origin [m]. Of squares row by
  /// row; of tags by their number, each top left, top right, bottom right, bottom left.
  [[nodiscard]] std::vector<cv::Point3f> corners() const;
  /// "board of 9 x 6 inner corners".
  [[nodiscard]] std::string text() const;
  /// Errors: Invalid (sizes that no such board has; a chessboard that looks the same from two
  /// sides).
  [[nodiscard]] Status check() const;
};

/// Corners of a board that both images show, in the same order [px].
struct BoardView {
  std::vector<cv::Point2f> left, right;
  std::vector<std::size_t> numbers;  ///< which of Board::corners(), ascending; empty: all

  [[nodiscard]] std::size_t number(std::size_t i) const { return numbers.empty() ? i : numbers[i]; }
  /// Where they are on the board [m].
  [[nodiscard]] std::vector<cv::Point3f> on(const Board& board) const;
};

/// Finds a chessboard in both images. It must be complete, with a white margin.
///
/// @param left, right  (H, W) or (H, W, 3) u8, red, green, blue.
/// Cost: 50 to 200 ms with a board, and at most as much without, whatever the images show.
/// Source: Duda and Frese, Accurate Detection and Localization of Checkerboard Corners for
/// Calibration, 2018 (as in OpenCV).
std::optional<BoardView> find_board(const cv::Mat& left, const cv::Mat& right, const Board& board);

/// Moves a chessboard's corners to where the edges around them meet.
///
/// Each corner is sought in a window in which there is no other line of the board, however it is
/// tilted.
/// @param grey  (H, W) u8.  @param[in,out] corners  row by row [px], right to a few pixels.
void refine_board(const cv::Mat& grey, const Board& board, std::vector<cv::Point2f>& corners);

/// The difference of two views: the mean distance of the corners that both show [px]; infinite if
/// there is none.
double difference(const BoardView& a, const BoardView& b);

}  // namespace hc::vision
