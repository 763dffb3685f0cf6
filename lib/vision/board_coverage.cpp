// SPDX-License-Identifier: Apache-2.0
#include <vision/board_coverage.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/calib3d.hpp>

namespace hc::vision {
namespace {

using Parts = std::array<bool, BoardCoverage::kParts>;

Parts parts_of(const std::vector<cv::Point2f>& corners, cv::Size size) {
  Parts parts = {};
  for (const auto& corner : corners) {
    const int column = std::clamp(static_cast<int>(3.0 * corner.x / size.width), 0, 2);
    const int row = std::clamp(static_cast<int>(3.0 * corner.y / size.height), 0, 2);
    const int part = 3 * row + column;
    parts[static_cast<std::size_t>(part)] = true;
  }
  return parts;
}

/// The normal of the board, away from the camera.
cv::Vec3d normal_of(const BoardView& view, const Board& board, cv::Size size) {
  const double focal = size.width;
  const cv::Matx33d M(focal, 0, size.width / 2.0, 0, focal, size.height / 2.0, 0, 0, 1);
  cv::Vec3d turn, shift;
  cv::Matx33d R;
  cv::solvePnP(view.on(board), view.left, M, {}, turn, shift);
  cv::Rodrigues(turn, R);
  const cv::Vec3d normal(R(0, 2), R(1, 2), R(2, 2));
  return normal[2] < 0 ? -normal : normal;
}

}  // namespace

BoardCoverage coverage_of(std::span<const BoardView> views, const Board& board, cv::Size size) {
  constexpr double kTilted = 0.25;  // [rad]
  BoardCoverage coverage;
  for (const auto& view : views) {
    const cv::Vec3d normal = normal_of(view, board, size);
    const double across = std::atan2(normal[0], normal[2]);
    const double down = std::atan2(normal[1], normal[2]);
    coverage.tilts[0] += across > kTilted;
    coverage.tilts[1] += across < -kTilted;
    coverage.tilts[2] += down > kTilted;
    coverage.tilts[3] += down < -kTilted;
    const Parts left = parts_of(view.left, size), right = parts_of(view.right, size);
    for (std::size_t i = 0; i < left.size(); ++i) coverage.parts[i] += left[i] && right[i];
  }
  return coverage;
}

std::string BoardCoverage::advice() const {
  constexpr std::size_t kWanted = 2;  // views of each tilt
  constexpr std::array kTilts = {"to the left (the left edge", "to the right (the right edge",
                                 "back (the upper edge", "forward (the lower edge"};
  constexpr std::array kPlaces = {"top left corner",    "upper edge", "top right corner",
                                  "left edge",          "middle",     "right edge",
                                  "bottom left corner", "lower edge", "bottom right corner"};
  const auto* tilt = std::ranges::min_element(tilts);
  if (*tilt < kWanted)
    return std::string("tilt the board ") + kTilts[static_cast<std::size_t>(tilt - tilts.begin())] +
           " in the image farther away)";
  const auto* part = std::ranges::min_element(parts);
  if (*part == 0)
    return std::string("move the board to the ") +
           kPlaces[static_cast<std::size_t>(part - parts.begin())] + " of the images";
  return "";
}

}  // namespace hc::vision
