// SPDX-License-Identifier: Apache-2.0
#include "block.h"

#include <algorithm>
#include <limits>

namespace {

// Heights of capital letters that a line is read at [px]: the network's errors differ between them.
constexpr int kHeights[] = {36, 30, 42};

/// Reads a line, again at another size as long as letters and glyphs do not fit together.
hc::vision::Reading read_line(Recogniser& recogniser, const cv::Mat& image,
                              const hc::vision::TextLine& line, bool upper_case) {
  hc::vision::Reading best;
  int least = std::numeric_limits<int>::max();
  for (const int height : kHeights) {
    const cv::Mat straight = hc::vision::straighten(image, line, height);
    auto reading = recogniser.read(straight);
    const auto [text, odd] = hc::vision::by_shape(straight, reading, upper_case);
    if (odd >= least) continue;
    least = odd;
    best = std::move(reading);
    best.text = text;
    if (odd == 0) break;
  }
  return best;
}

}  // namespace

hc::vision::Reading read_block(Recogniser& recogniser, const cv::Mat& image,
                               const std::vector<hc::vision::TextLine>& block, bool upper_case) {
  hc::vision::Reading all{"", 1, {}};
  for (const auto& line : block) {
    const auto reading = read_line(recogniser, image, line, upper_case);
    all.text += (all.text.empty() || reading.text.empty() ? "" : " ") + reading.text;
    all.confidence = std::min(all.confidence, reading.confidence);
  }
  return all;
}
