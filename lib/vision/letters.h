// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds lines of dark or bright letters on an even ground, as on a board, and straightens them for
// recognition. No recognition, no messages; plain cv::Mat in and out.

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// A line of letters in an image.
struct TextLine {
  /// Around the letters without a margin, in reading orientation: top left, top right, bottom
  /// right, bottom left [px]. Descenders may protrude.
  std::array<cv::Point2f, 4> corners;
  int letters = 0;         ///< approximate; wide pieces count as several touching letters
  double height = 0;       ///< of capital letters [px]
  double score = 0;        ///< similarity to a line on a clean board, 0 … 1
  bool is_bright = false;  ///< brighter than the ground
  bool is_whole = true;    ///< inside the image with a margin; otherwise letters may be missing

  [[nodiscard]] cv::Point2f middle() const;
  [[nodiscard]] double width() const;    ///< [px]
  [[nodiscard]] double angle() const;    ///< from level, positive if it descends to the right [rad]
  [[nodiscard]] cv::Rect2f box() const;  ///< level, around the corners [px]
};

/// Finds lines of at least two letters that are darker or brighter than their ground, from 8 pixels
/// to a quarter of the image high, at most about 20° from level.
///
/// @param image  (H, W, 3) or (H, W, 1) u8; tolerates noise of a standard deviation of 20.
/// @param min_score  lines with a lower score are dropped.
/// @returns  best first, without lines that overlap a better one.
/// Cost: about 15 ms for 800 × 600; more if the best line is inclined and searched again.
std::vector<TextLine> find_text_lines(const cv::Mat& image, double min_score = 0.4);

/// The best line with those above and below it on the same board, from top to bottom.
///
/// @param lines  the best first.
std::vector<TextLine> block_of_best(const std::vector<TextLine>& lines);

/// Whether all lines of a block are whole.
bool is_whole(const std::vector<TextLine>& block);

/// The level box around the lines of a block, at least one [px].
cv::Rect2f box_of(const std::vector<TextLine>& block);

/// Cuts out a line: levelled, upright, with a margin, denoised, black on white.
///
/// @param letter_height  of capital letters in the result [px].
/// @returns  (H, W) u8.
cv::Mat straighten(const cv::Mat& image, const TextLine& line, int letter_height = 36);

/// The grey image with the least noise: the mean of the channels. (H, W) u8.
cv::Mat mean_of_channels(const cv::Mat& image);

/// Standard deviation of a grey image's noise, (H, W) u8.
/// Source: J. Immerkær, Fast noise variance estimation, Computer Vision and Image Understanding
/// 64(2), 1996; with the median instead of the mean, to ignore edges.
double noise_of(const cv::Mat& grey);

}  // namespace hc::vision
