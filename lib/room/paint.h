// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images for the surfaces of the world. Pure; the same seed gives the same bytes.

#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

namespace hc::room {

// All give (H, W, 3) u8, red, green, blue.

/// A colour with grains of several sizes, as of plaster, cloth or stone: what stereo needs.
///
/// @param strength  greatest change of a colour, 0 … 255.
cv::Mat paint_grains(int width, int height, const cv::Scalar& rgb, double strength,
                     std::uint64_t seed);
/// Planks along x.
cv::Mat paint_planks(int width, int height, std::uint64_t seed);
/// An image of coloured shapes, in none of the colours that markers and the ball have.
cv::Mat paint_poster(int width, int height, std::uint64_t seed);
/// A black and white marker with a white margin of one cell. The image has 8 pixels a cell.
///
/// @param dictionary  "aruco" (6×6_250) or "apriltag" (36h11). @param id  within it.
cv::Mat paint_tag(const std::string& dictionary, int id);
/// A coloured square on white, margin 1/6 of the side.
cv::Mat paint_marker(const cv::Scalar& rgb);
/// Block letters on a white board, black, as large as they fit in one line, or in several that are
/// separated by line feeds.
///
/// @param text  UTF-8; in DejaVu Sans if it is not ASCII, with "?" for others where that is not
/// installed.
cv::Mat paint_board(const std::string& text, int width, int height);

}  // namespace hc::room
