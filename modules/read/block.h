// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads what is on a board, one line or several, and no more often than is asked for.

#include <cstdint>
#include <optional>
#include <vector>

#include <vision/letters.h>
#include <opencv2/core.hpp>

#include "recogniser.h"

class BlockReader {
 public:
  using Block = std::vector<hc::vision::TextLine>;

  /// Errors: as Recogniser::make(), which says what the parameters are.
  static hc::Result<BlockReader> make(const std::string& language, bool upper_case);

  /// What is written in the lines of a block, joined by spaces, as sure as the least sure line.
  /// @param image  (H, W, 3) or (H, W, 1) u8.
  hc::vision::Reading read(const cv::Mat& image, const Block& block);

  /// The same, if the block is whole and the last reading is 1 / rate ago by the times of the
  /// images, so that a recording gives the same result.
  /// @param time  of the image [ns].
  /// @param rate  maximum number of readings a second, 0: all [Hz].
  std::optional<hc::vision::Reading> read_when_due(const cv::Mat& image, const Block& block,
                                                   std::int64_t time, double rate);

 private:
  BlockReader(Recogniser recogniser, bool upper_case);
  [[nodiscard]] bool is_due(std::int64_t time, double rate) const;

  Recogniser recogniser_;
  bool upper_case_;
  std::optional<std::int64_t> read_at_;  // the time of the last image that was due [ns]
};
