// SPDX-License-Identifier: Apache-2.0
#pragma once
// A calibration board as it is printed. Pure.

#include <cstdint>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <vision/board.h>
#include <opencv2/core.hpp>

namespace hc::vision {

/// Areas on white paper, from its top left edge [m].
struct BoardPrint {
  struct Area {
    cv::Rect2d place;
    bool is_black = true;
  };
  cv::Size2d paper;         ///< the board and its margin
  cv::Point2d origin;       ///< of Board::corners()
  std::vector<Area> areas;  ///< later ones are on top
};

/// @param dictionary  of a ChArUco board.
/// Errors: as for MarkedBoardFinder::make().
Result<BoardPrint> print_of(const Board& board, const std::string& dictionary = "");

/// @param dot  side of a pixel [m].  @returns  (H, W) u8.
cv::Mat image_of(const BoardPrint& print, double dot, std::uint8_t black = 0,
                 std::uint8_t white = 255);

/// A PDF file of one page as large as the paper.
std::string pdf_of(const BoardPrint& print);

}  // namespace hc::vision
