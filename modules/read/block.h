// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the lines of text on a board, or a cropped word, at a limited rate.

#include <cstdint>
#include <optional>
#include <vector>

#include <hc/base/time.h>
#include <vision/letters.h>
#include <opencv2/core.hpp>

#include "recogniser.h"

class BlockReader {
 public:
  using Block = std::vector<hc::vision::TextLine>;

  /// Parameters and errors: as Recogniser::make().
  static hc::Result<BlockReader> make(const std::string& language, bool upper_case);

  /// The text in an image: the best lines on a board, or the whole image if it is a crop, smaller
  /// or wider than the images of cameras; empty if there is none.
  /// @param image  (H, W, 3) or (H, W, 1) u8.
  /// @param min_score  as find_text_lines().
  static Block find(const cv::Mat& image, double min_score);

  /// The text of a block's lines, joined by spaces, with the confidence of the least certain line.
  /// @param block  of find(image).
  hc::vision::Reading read(const cv::Mat& image, const Block& block);

  /// Reads if the block is whole and the last reading is 1 / rate ago, by the times of the images,
  /// so that a recording gives the same result.
  /// @param time  of the image.
  /// @param rate  maximum number of readings a second, 0: all [Hz].
  std::optional<hc::vision::Reading> read_when_due(const cv::Mat& image, const Block& block,
                                                   hc::Time time, double rate);

 private:
  BlockReader(Recogniser recogniser, bool upper_case);
  [[nodiscard]] bool is_due(hc::Time time, double rate) const;

  Recogniser recogniser_;
  bool upper_case_;
  std::optional<hc::Time> read_at_;  // time of the last image read
};
