// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images for the surfaces of the world. Pure; the same seed gives the same bytes.

#include <cstdint>
#include <string>

#include <opencv2/core.hpp>

namespace hc::room {

// All return (H, W, 3) u8, red, green, blue.

/// A colour with grains of several sizes, like plaster, cloth or stone; texture for stereo.
///
/// @param strength  maximum change of a colour, 0 … 255.
cv::Mat paint_grains(int width, int height, const cv::Scalar& rgb, double strength,
                     std::uint64_t seed);
/// Planks along x.
cv::Mat paint_planks(int width, int height, std::uint64_t seed);
/// Coloured shapes, in other colours than the markers and the ball.
cv::Mat paint_poster(int width, int height, std::uint64_t seed);
/// A black and white marker with a white margin of one cell; 8 pixels per cell.
///
/// @param dictionary  "aruco" (6×6_250) or "apriltag" (36h11). @param id  within it.
cv::Mat paint_tag(const std::string& dictionary, int id);
/// A coloured square on white, margin 1/6 of the side.
cv::Mat paint_marker(const cv::Scalar& rgb);
/// Black block letters on a white board, as large as possible; lines are separated by line feeds.
///
/// @param text  UTF-8; if it is not ASCII, in DejaVu Sans, or with "?" if that is not installed.
cv::Mat paint_board(const std::string& text, int width, int height);

}  // namespace hc::room
