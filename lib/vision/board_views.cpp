// SPDX-License-Identifier: Apache-2.0
#include <vision/board_views.h>

#include <algorithm>
#include <utility>

namespace hc::vision {

Result<BoardViews> BoardViews::make(const Board& board) {
  if (board.columns == board.rows) return Error{Code::Invalid, "columns and rows are equal"};
  return BoardViews(board);
}

Result<bool> BoardViews::take(const cv::Mat& left, const cv::Mat& right, double min_difference) {
  if (left.size() != right.size() || (!image_size_.empty() && left.size() != image_size_))
    return Error{Code::Unsupported, "the images have different sizes"};
  image_size_ = left.size();
  auto view = find_board(left, right, board_);
  const double far = min_difference * image_size_.width;
  if (!view || std::ranges::any_of(
                   views_, [&](const BoardView& other) { return difference(*view, other) < far; }))
    return false;
  views_.push_back(std::move(*view));
  return true;
}

Result<Calibrated> BoardViews::calibrate() const {
  return vision::calibrate(views_, board_, image_size_);
}

}  // namespace hc::vision
