// SPDX-License-Identifier: Apache-2.0
#include <vision/board_layout.h>

namespace hc::vision {
namespace {

std::array<cv::Point2f, 4> square_at(double left, double top, double side) {
  const auto x = static_cast<float>(left), y = static_cast<float>(top);
  const auto right = static_cast<float>(left + side), bottom = static_cast<float>(top + side);
  return {{{x, y}, {right, y}, {right, bottom}, {x, bottom}}};
}

std::vector<BoardMarker> charuco(const Board& board, bool is_legacy) {
  std::vector<BoardMarker> markers;
  const double margin = (board.square - board.marker) / 2;
  const int first = is_legacy && board.rows % 2 == 0 ? 0 : 1;
  for (int row = 0; row < board.rows; ++row)
    for (int column = (row + first) % 2; column < board.columns; column += 2) {
      // The first inner corner is the origin.
      BoardMarker marker{square_at((column - 1) * board.square + margin,
                                   (row - 1) * board.square + margin, board.marker),
                         {}};
      const auto inner = [&](int x, int y) -> std::optional<std::size_t> {
        if (x < 1 || y < 1 || x >= board.columns || y >= board.rows) return std::nullopt;
        return static_cast<std::size_t>((y - 1) * (board.columns - 1) + x - 1);
      };
      marker.nearest = {inner(column, row), inner(column + 1, row), inner(column + 1, row + 1),
                        inner(column, row + 1)};
      markers.push_back(marker);
    }
  return markers;
}

std::vector<BoardMarker> april_grid(const Board& board) {
  std::vector<BoardMarker> markers;
  const auto corners = board.corners();
  for (std::size_t first = 0; first < corners.size(); first += 4) {
    BoardMarker marker;
    for (std::size_t i = 0; i < 4; ++i) {
      marker.corners[i] = {corners[first + i].x, corners[first + i].y};
      marker.nearest[i] = first + i;
    }
    markers.push_back(marker);
  }
  return markers;
}

}  // namespace

std::vector<BoardMarker> layout_of(const Board& board, bool is_legacy) {
  if (board.kind == BoardKind::Charuco) return charuco(board, is_legacy);
  if (board.kind == BoardKind::AprilGrid) return april_grid(board);
  return {};
}

}  // namespace hc::vision
