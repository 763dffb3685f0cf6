// SPDX-License-Identifier: Apache-2.0
#pragma once
// Collects different views of a chessboard to calibrate two cameras. No messages; plain cv::Mat in.

#include <cstddef>
#include <vector>

#include <hc/base/result.h>
#include <vision/board.h>
#include <vision/stereo_fit.h>
#include <opencv2/core.hpp>

namespace hc::vision {

class BoardViews {
 public:
  /// Errors: Invalid (columns equal rows).
  static Result<BoardViews> make(const Board& board);

  /// Finds the board in a pair of images, and keeps the view unless it is too similar to another.
  ///
  /// @param left, right  as for find_board().
  /// @param min_difference  minimum difference() from any other view, as a share of the
  ///     images' width, 0 … 1.
  /// @returns  whether the view was kept. Errors: Unsupported (images of different sizes).
  Result<bool> take(const cv::Mat& left, const cv::Mat& right, double min_difference);

  [[nodiscard]] std::size_t size() const { return views_.size(); }
  /// Calibrates the cameras from the views so far; errors and cost as for calibrate().
  [[nodiscard]] Result<Calibrated> calibrate() const;

 private:
  explicit BoardViews(const Board& board) : board_(board) {}

  Board board_;
  std::vector<BoardView> views_;
  cv::Size image_size_;  // of all images; empty before the first
};

}  // namespace hc::vision
