// SPDX-License-Identifier: Apache-2.0
#include <vision/board_print.h>

#include <cmath>
#include <cstdint>

#include <hc/base/format.h>
#include <vision/board_layout.h>
#include <vision/marker_finder.h>

namespace hc::vision {
namespace {

/// @param cells  inside the border.  @param border  width of the border [cell].
void add_marker(BoardPrint& print, const BoardMarker& marker, const cv::Mat& cells, int border) {
  const cv::Point2d at = print.origin + cv::Point2d(marker.corners[0]);
  const double side = marker.corners[1].x - marker.corners[0].x;
  const double cell = side / (cells.cols + 2 * border);
  print.areas.push_back({{at.x, at.y, side, side}});
  for (int row = 0; row < cells.rows; ++row)
    for (int column = 0; column < cells.cols; ++column)
      if (cells.at<std::uint8_t>(row, column) != 0)
        print.areas.push_back(
            {{at.x + (column + border) * cell, at.y + (row + border) * cell, cell, cell}, false});
}

/// The squares of a chessboard whose top left one is black, in a margin of a square.
BoardPrint squares(int columns, int rows, double side) {
  BoardPrint print{{(columns + 2) * side, (rows + 2) * side}, {2 * side, 2 * side}, {}};
  for (int row = 0; row < rows; ++row)
    for (int column = row % 2; column < columns; column += 2)
      print.areas.push_back({{(column + 1) * side, (row + 1) * side, side, side}});
  return print;
}

BoardPrint tags_of(const Board& board) {
  constexpr int kBorder = 2;  // as Kalibr prints it
  const double side = board.marker, gap = board.spacing * side;
  const auto length = [&](int tags) { return tags * (side + gap) + 3 * gap; };
  BoardPrint print{{length(board.columns), length(board.rows)}, {2 * gap, 2 * gap}, {}};
  for (int row = 0; row <= board.rows; ++row)
    for (int column = 0; column <= board.columns; ++column)
      print.areas.push_back({{gap + column * (side + gap), gap + row * (side + gap), gap, gap}});
  const auto layout = layout_of(board);
  for (std::size_t id = 0; id < layout.size(); ++id)
    add_marker(print, layout[id], apriltag_cells(static_cast<int>(id)), kBorder);
  return print;
}

}  // namespace

Result<BoardPrint> print_of(const Board& board, const std::string& dictionary) {
  HC_TRY(board.check());
  if (board.kind == BoardKind::AprilGrid) return tags_of(board);
  if (board.kind == BoardKind::Chessboard)
    return squares(board.columns + 1, board.rows + 1, board.square);
  const auto markers = HC_TRY(ArucoFinder::make(dictionary));
  const auto layout = layout_of(board);
  HC_TRY(markers.has(layout.size()));
  BoardPrint print = squares(board.columns, board.rows, board.square);
  for (std::size_t id = 0; id < layout.size(); ++id)
    add_marker(print, layout[id], markers.cells(static_cast<int>(id)), 1);
  return print;
}

cv::Mat image_of(const BoardPrint& print, double dot, std::uint8_t black, std::uint8_t white) {
  const auto pixel = [&](double length) { return static_cast<int>(std::lround(length / dot)); };
  cv::Mat image(pixel(print.paper.height), pixel(print.paper.width), CV_8U, cv::Scalar(white));
  for (const auto& [place, is_black] : print.areas)
    image(cv::Rect(cv::Point(pixel(place.x), pixel(place.y)),
                   cv::Point(pixel(place.x + place.width), pixel(place.y + place.height))))
        .setTo(is_black ? black : white);
  return image;
}

std::string pdf_of(const BoardPrint& print) {
  constexpr double kPoint = 0.0254 / 72;  // [m]
  const auto points = [](double length) { return length / kPoint; };
  std::string drawing;
  for (const auto& [place, is_black] : print.areas)
    drawing += hc::format("{} g {:.4f} {:.4f} {:.4f} {:.4f} re f\n", is_black ? 0 : 1,
                          points(place.x), points(print.paper.height - place.y - place.height),
                          points(place.width), points(place.height));
  const std::string objects[] = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      hc::format("<< /Type /Page /Parent 2 0 R /Resources << >> /Contents 4 0 R "
                 "/MediaBox [0 0 {:.4f} {:.4f}] >>",
                 points(print.paper.width), points(print.paper.height)),
      hc::format("<< /Length {} >>\nstream\n{}endstream", drawing.size(), drawing)};
  std::string pdf = "%PDF-1.6\n", places = "0000000000 65535 f \n";
  int number = 0;
  for (const auto& object : objects) {
    places += hc::format("{:010} 00000 n \n", pdf.size());
    pdf += hc::format("{} 0 obj\n{}\nendobj\n", ++number, object);
  }
  return pdf +
         hc::format("xref\n0 {}\n{}trailer\n<< /Size {} /Root 1 0 R >>\nstartxref\n{}\n%%EOF\n",
                    number + 1, places, number + 1, pdf.size());
}

}  // namespace hc::vision
