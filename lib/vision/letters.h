// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds lines of letters on an even ground, dark or bright, as on a board, and sets them straight
// for a reader. No recognition, no messages; plain cv::Mat in and out.

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// A line of letters in an image.
struct TextLine {
  /// Around the letters without a margin, as one who reads calls them: top left, top right, bottom
  /// right, bottom left [px]. Letters with a descender may protrude below.
  std::array<cv::Point2f, 4> corners;
  int letters = 0;    ///< about; pieces that look like letters, wide ones as several that touch
  double height = 0;  ///< of capital letters [px]
  double score = 0;   ///< how much it is like a line on a clean board, 0 … 1
  bool is_bright = false;  ///< brighter than the ground
  bool is_whole = true;    ///< inside the image with a margin; otherwise letters may be missing

  [[nodiscard]] cv::Point2f middle() const;
  [[nodiscard]] double width() const;    ///< [px]
  [[nodiscard]] double angle() const;    ///< from level, positive where it falls to the right [rad]
  [[nodiscard]] cv::Rect2f box() const;  ///< level, around the corners [px]
};

/// Finds lines of at least two letters that are darker or brighter than their ground, from 8 pixels
/// to a quarter of the image high, at most about 20° from level.
///
/// @param image  (H, W, 3) or (H, W, 1) u8; noise of a standard deviation of 20 does no harm.
/// @param min_score  lines that are less like one on a board are dropped.
/// @returns  the best first; none overlaps a better one.
/// Cost: about 15 ms for 800 × 600; more where the best line is not level, as it is searched again.
std::vector<TextLine> find_text_lines(const cv::Mat& image, double min_score = 0.4);

/// The best of the lines with those above and below it, as on one board, from top to bottom.
///
/// @param lines  the best first.
std::vector<TextLine> block_of_best(const std::vector<TextLine>& lines);

/// Whether all lines of a block are.
bool is_whole(const std::vector<TextLine>& block);

/// Level, around the lines of a block, of which there is at least one [px].
cv::Rect2f box_of(const std::vector<TextLine>& block);

/// Cuts a line out: level, its letters upright, with a margin, without noise, its ground white and
/// its letters black.
///
/// @param letter_height  of the capital letters in the result [px].
/// @returns  (H, W) u8.
cv::Mat straighten(const cv::Mat& image, const TextLine& line, int letter_height = 36);

/// The grey image with the least noise: the mean of the channels. (H, W) u8.
cv::Mat mean_of_channels(const cv::Mat& image);

/// Standard deviation of a grey image's noise, (H, W) u8.
/// Source: J. Immerkær, Fast noise variance estimation, Computer Vision and Image Understanding
/// 64(2), 1996; by the median in place of the mean, which edges do not raise.
double noise_of(const cv::Mat& grey);

}  // namespace hc::vision
