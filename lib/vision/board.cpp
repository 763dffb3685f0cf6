// SPDX-License-Identifier: Apache-2.0
#include <vision/board.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include <hc/base/format.h>
#include <vision/crossing.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

using Corners = std::vector<cv::Point2f>;

constexpr int kAprilTags = 587;  // of the family 36h11

/// The room around a corner; see room_around().
float room_of(const Corners& corners, const Board& board, int row, int column) {
  const auto at = [&](int r, int c) {
    const int number = r * board.columns + c;
    return corners[static_cast<std::size_t>(number)];
  };
  const cv::Point2f p = at(row, column);
  float room = std::numeric_limits<float>::infinity();
  for (const int r : {row - 1, row + 1})
    for (const int c : {column - 1, column + 1})
      if (r >= 0 && r < board.rows && c >= 0 && c < board.columns)
        room = std::min(room, room_around(at(row, c) - p, at(r, column) - p));
  return room;
}

/// The sum of differences of pairs of neighbours in a line of squares [grey level].
///
/// @param at, step  the middle of the first square and the way to the next, in squares.
double contrast(const cv::Mat& grey, const cv::Matx33d& H, cv::Point2d at, cv::Point2d step,
                int squares) {
  std::vector<cv::Point2d> middles;
  middles.reserve(static_cast<std::size_t>(squares));
  for (int i = 0; i < squares; ++i) middles.push_back(at + i * step);
  cv::perspectiveTransform(middles, middles, H);
  const cv::Rect image(cv::Point(), grey.size());
  double sum = 0;
  for (std::size_t i = 0; i + 1 < middles.size(); i += 2) {
    const cv::Point one = middles[i], other = middles[i + 1];
    if (image.contains(one) && image.contains(other))
      sum += grey.at<std::uint8_t>(one) - grey.at<std::uint8_t>(other);
  }
  return std::abs(sum);
}

/// Whether the corners are only a part of a larger board: its squares go on beyond the margin.
bool is_part(const cv::Mat& grey, const Board& board, const Corners& corners) {
  std::vector<cv::Point2f> places;
  for (const auto& corner : Board{board.columns, board.rows, 1}.corners())
    places.emplace_back(corner.x, corner.y);
  const cv::Matx33d H = cv::findHomography(places, corners);
  const double right = board.columns - 1, bottom = board.rows - 1;
  // From the outermost corners, in squares; the outermost squares may be cut off.
  constexpr double kInside = -0.5, kOutside = 1.5;
  const auto goes_on = [&](cv::Point2d from, cv::Point2d outwards, cv::Point2d along, int squares) {
    const cv::Point2d middle = from + 0.5 * along;
    return contrast(grey, H, middle + kOutside * outwards, along, squares) >
           contrast(grey, H, middle + kInside * outwards, along, squares) / 2;
  };
  return goes_on({0, 0}, {0, -1}, {1, 0}, board.columns - 1) ||
         goes_on({0, bottom}, {0, 1}, {1, 0}, board.columns - 1) ||
         goes_on({0, 0}, {-1, 0}, {0, 1}, board.rows - 1) ||
         goes_on({right, 0}, {1, 0}, {0, 1}, board.rows - 1);
}

/// Whether corners are evenly spaced along rows and columns, as far as perspective and lenses
/// allow.
bool are_even(const Board& board, const Corners& corners) {
  constexpr double kMost = 0.25;  // change from one distance to the next, of their mean
  const auto is_even = [&](int at, int step) {
    const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
    const cv::Point2f one = corner(at + step) - corner(at);
    const cv::Point2f other = corner(at + 2 * step) - corner(at + step);
    return cv::norm(other - one) < kMost * cv::norm(one + other) / 2;
  };
  for (int row = 0; row < board.rows; ++row)
    for (int column = 0; column < board.columns; ++column) {
      const int at = row * board.columns + column;
      if ((column + 2 < board.columns && !is_even(at, 1)) ||
          (row + 2 < board.rows && !is_even(at, board.columns)))
        return false;
    }
  return true;
}

bool find_corners(const cv::Mat& image, const Board& board, Corners& corners) {
  constexpr int kSmallest = 32, kLargest = 640;  // sides of an image that is searched [px]
  if (std::min(image.cols, image.rows) < kSmallest) return false;
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_RGB2GRAY);
  const double scale = std::min(1.0, 1.0 * kLargest / std::max(grey.cols, grey.rows));
  cv::Mat small = grey;
  if (scale < 1) cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
  const cv::Size size(board.columns, board.rows);
  if (!cv::findChessboardCornersSB(small, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE) ||
      is_part(small, board, corners))
    return false;
  // The centre of the top left pixel is at (0, 0) in both images.
  const cv::Point2f half(0.5F, 0.5F);
  if (scale < 1)
    for (auto& corner : corners) corner = (corner + half) / scale - half;
  refine_board(grey, board, corners);
  return are_even(board, corners);
}

/// Places row by row [m].
std::vector<cv::Point3f> rows_of(int columns, int rows, double square) {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      points.emplace_back(static_cast<float>(column * square), static_cast<float>(row * square),
                          0.0F);
  return points;
}

}  // namespace

std::vector<cv::Point3f> Board::corners() const {
  if (kind == BoardKind::Chessboard) return rows_of(columns, rows, square);
  if (kind == BoardKind::Charuco) return rows_of(columns - 1, rows - 1, square);
  std::vector<cv::Point3f> points;
  const double pitch = marker * (1 + spacing);
  for (int row = rows - 1; row >= 0; --row)
    for (int column = 0; column < columns; ++column)
      for (const auto& [right, down] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        points.emplace_back(static_cast<float>(column * pitch + right * marker),
                            static_cast<float>(row * pitch + down * marker), 0.0F);
  return points;
}

std::string Board::text() const {
  const char* form = kind == BoardKind::Chessboard ? "board of {} x {} inner corners"
                     : kind == BoardKind::Charuco  ? "ChArUco board of {} x {} squares"
                                                   : "AprilGrid of {} x {} tags";
  return hc::format(form, columns, rows);
}

Status Board::check() const {
  const auto invalid = [](const char* why) { return Error{Code::Invalid, why}; };
  if (kind == BoardKind::AprilGrid) {
    if (columns < 2 || rows < 2) return invalid("columns and rows: at least 2 tags each");
    if (columns * rows > kAprilTags) return invalid("columns and rows: 36h11 has 587 tags");
    if (!(marker > 0)) return invalid("marker_size is missing: the side of a tag");
    if (!(spacing > 0)) return invalid("tag_spacing is 0: it is relative to the side of a tag");
    return {};
  }
  if (columns < 3 || rows < 3) return invalid("columns and rows: at least 3 each");
  if (!(square > 0)) return invalid("square is not above 0");
  if (kind == BoardKind::Chessboard)
    return columns == rows ? Status(invalid("columns and rows are equal")) : Status();
  if (!(marker > 0)) return invalid("marker_size is missing: the side of a marker");
  if (!(marker < square)) return invalid("marker_size is not below square");
  return {};
}

std::vector<cv::Point3f> BoardView::on(const Board& board) const {
  const auto all = board.corners();
  std::vector<cv::Point3f> shown;
  for (std::size_t i = 0; i < left.size(); ++i) shown.push_back(all[number(i)]);
  return shown;
}

void refine_board(const cv::Mat& grey, const Board& board, std::vector<cv::Point2f>& corners) {
  const Corners rough = corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    refine_crossing(grey,
                    room_of(rough, board, static_cast<int>(i) / board.columns,
                            static_cast<int>(i) % board.columns),
                    corners[i]);
}

std::optional<BoardView> find_board(const cv::Mat& left, const cv::Mat& right, const Board& board) {
  BoardView view;
  if (!find_corners(left, board, view.left) || !find_corners(right, board, view.right))
    return std::nullopt;
  // Detection may start at either end of a board; make it the same one in both images.
  const cv::Point2f along_left = view.left.back() - view.left.front();
  const cv::Point2f along_right = view.right.back() - view.right.front();
  if (along_left.dot(along_right) < 0) std::reverse(view.right.begin(), view.right.end());
  return view;
}

double difference(const BoardView& a, const BoardView& b) {
  double sum = 0;
  std::size_t common = 0;
  for (std::size_t i = 0, j = 0; i < a.left.size() && j < b.left.size();) {
    const auto one = a.number(i), other = b.number(j);
    if (one == other) {
      sum += cv::norm(a.left[i] - b.left[j]) + cv::norm(a.right[i] - b.right[j]);
      ++common;
    }
    i += one <= other;
    j += other <= one;
  }
  return common == 0 ? std::numeric_limits<double>::infinity()
                     : sum / static_cast<double>(2 * common);
}

}  // namespace hc::vision
