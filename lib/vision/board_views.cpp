// SPDX-License-Identifier: Apache-2.0
#include <vision/board_views.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <hc/base/format.h>
#include <opencv2/imgproc.hpp>

namespace hc::vision {

Result<BoardViews> BoardViews::make(const Board& board, std::size_t most,
                                    const std::string& dictionary) {
  HC_TRY(board.check());
  BoardViews views(board, most);
  if (board.kind != BoardKind::Chessboard)
    views.finder_ = HC_TRY(MarkedBoardFinder::make(board, dictionary));
  return views;
}

Result<bool> BoardViews::take(const cv::Mat& left, const cv::Mat& right, double min_difference) {
  if (left.size() != right.size() || (!image_size_.empty() && left.size() != image_size_))
    return Error{Code::Unsupported, "the images have different sizes"};
  image_size_ = left.size();
  ++pairs_;
  last_ = finder_ ? finder_->find(left, right) : find_board(left, right, board_);
  if (!last_) return false;
  ++found_;
  const double far = min_difference * image_size_.width;
  if (std::ranges::any_of(views_,
                          [&](const BoardView& other) { return difference(*last_, other) < far; }))
    return false;
  views_.push_back(*last_);
  if (views_.size() > most_) thin_out();
  advice_ = coverage_of(views_, board_, image_size_).advice();
  return true;
}

void BoardViews::thin_out() {
  double least = std::numeric_limits<double>::infinity();
  auto older = views_.begin();
  for (auto one = views_.begin(); one != views_.end(); ++one)
    for (auto other = one + 1; other != views_.end(); ++other)
      if (const double apart = difference(*one, *other); apart < least) {
        least = apart;
        older = one;
      }
  views_.erase(older);
}

Result<Calibrated> BoardViews::calibrate() const {
  auto calibrated = vision::calibrate(views_, board_, image_size_);
  if (calibrated) return calibrated;
  Error error = calibrated.error();
  if (views_.size() < kLeastViews)
    error.detail +=
        hc::format("; the {} was found in {} of {} pairs", board_.text(), found_, pairs_);
  else if (!advice_.empty())
    error.detail += "; " + advice_;
  return error;
}

double BoardViews::error_of(const StereoCalibration& calibration) const {
  return vision::error_of(calibration, views_, board_);
}

cv::Mat BoardViews::picture(const cv::Mat& left) const {
  cv::Mat picture;
  if (left.channels() == 3)
    left.copyTo(picture);
  else
    cv::cvtColor(left, picture, cv::COLOR_GRAY2RGB);
  const cv::Scalar green(0, 200, 0), red(255, 60, 60), white(255, 255, 255), black(0, 0, 0);
  cv::Mat covered = picture.clone();
  for (const auto& view : views_) {
    std::vector<cv::Point2f> hull;
    cv::convexHull(view.left, hull);
    cv::fillConvexPoly(covered, std::vector<cv::Point>(hull.begin(), hull.end()), green);
  }
  cv::addWeighted(covered, 0.3, picture, 0.7, 0, picture);
  if (last_)
    for (const auto& corner : last_->left) cv::circle(picture, corner, 3, red, cv::FILLED);
  const std::string line = hc::format("{} views. {}", views_.size(), advice_);
  const double scale = picture.cols / 1200.0;
  for (const auto& [colour, width] : {std::pair{black, 4}, {white, 1}})
    cv::putText(picture, line, cv::Point(8, static_cast<int>(30 * scale) + 8),
                cv::FONT_HERSHEY_SIMPLEX, scale, colour, width, cv::LINE_AA);
  return picture;
}

}  // namespace hc::vision
