// SPDX-License-Identifier: Apache-2.0
#pragma once
// Collects views of a chessboard that differ, to calibrate two cameras by. No messages; plain
// cv::Mat in.

#include <cstddef>
#include <vector>

#include <hc/base/result.h>
#include <vision/calibration.h>
#include <opencv2/core.hpp>

namespace hc::vision {

class BoardViews {
 public:
  /// Errors: Invalid (as many corners in a row as in a column).
  static Result<BoardViews> make(const Board& board);

  /// Finds the board in a pair of images, and keeps the view unless it is too similar to another.
  ///
  /// @param left, right  as of find_board().
  /// @param min_difference  minimum difference() from any other view, as a share of the
  ///     images' width, 0 … 1.
  /// @returns  whether it took one. Errors: Unsupported (images of another size).
  Result<bool> take(const cv::Mat& left, const cv::Mat& right, double min_difference);

  [[nodiscard]] std::size_t size() const { return views_.size(); }
  /// Calibrates the cameras by the views so far; errors and cost as of calibrate().
  [[nodiscard]] Result<Calibrated> calibrate() const;

 private:
  explicit BoardViews(const Board& board) : board_(board) {}

  Board board_;
  std::vector<BoardView> views_;
  cv::Size image_size_;  // of all images; empty: there was none
};

}  // namespace hc::vision
