// SPDX-License-Identifier: Apache-2.0
#pragma once
// Collects different views of a board to calibrate two cameras. No messages; plain cv::Mat in.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <vision/board.h>
#include <vision/board_coverage.h>
#include <vision/marked_board.h>
#include <vision/stereo_fit.h>
#include <opencv2/core.hpp>

namespace hc::vision {

class BoardViews {
 public:
  /// @param most  views to keep: a further one replaces one that hardly differs from another.
  /// @param dictionary  of a ChArUco board.
  /// Errors: Invalid (as Board::check()); as for MarkedBoardFinder::make().
  static Result<BoardViews> make(const Board& board, std::size_t most,
                                 const std::string& dictionary = "");

  /// Finds the board in a pair of images, and keeps the view unless it is too similar to another.
  ///
  /// @param left, right  as for find_board(), MarkedBoardFinder::find().
  /// @param min_difference  minimum difference() from any other view, as a share of the
  ///     images' width, 0 … 1.
  /// @returns  whether the view was kept. Errors: Unsupported (images of different sizes).
  Result<bool> take(const cv::Mat& left, const cv::Mat& right, double min_difference);

  [[nodiscard]] const Board& board() const { return board_; }
  [[nodiscard]] std::size_t size() const { return views_.size(); }
  /// Pairs of images so far, and those in which the board was found.
  [[nodiscard]] std::size_t pairs() const { return pairs_; }
  [[nodiscard]] std::size_t found() const { return found_; }

  /// Calibrates the cameras from the views so far; errors and cost as for calibrate(). An error
  /// says which view is missing.
  [[nodiscard]] Result<Calibrated> calibrate() const;
  /// What to do next with the board; see BoardCoverage.
  [[nodiscard]] const std::string& advice() const { return advice_; }
  /// error_of() with these views.
  [[nodiscard]] double error_of(const StereoCalibration& calibration) const;

  /// The left image of the last pair with the boards of all views and the corners of this one; with
  /// lines of text at the top.
  /// @param left  as given to take().  @returns  (H, W, 3) u8, red, green, blue.
  [[nodiscard]] cv::Mat picture(const cv::Mat& left) const;

 private:
  BoardViews(const Board& board, std::size_t most) : board_(board), most_(most) {}
  /// Removes the older one of the two views that differ least.
  void thin_out();

  Board board_;
  std::optional<MarkedBoardFinder> finder_;  // unless it is a chessboard
  std::size_t most_;
  std::vector<BoardView> views_;
  std::optional<BoardView> last_;  // of the last pair
  cv::Size image_size_;            // of all images; empty before the first
  std::string advice_ = BoardCoverage{}.advice();
  std::size_t pairs_ = 0, found_ = 0;
};

}  // namespace hc::vision
