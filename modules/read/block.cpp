// SPDX-License-Identifier: Apache-2.0
#include "block.h"

#include <algorithm>

hc::vision::Reading read_block(Recogniser& recogniser, const cv::Mat& image,
                               const std::vector<hc::vision::TextLine>& block, bool upper_case) {
  hc::vision::Reading all{"", 1, {}};
  for (const auto& line : block) {
    const cv::Mat straight = hc::vision::straighten(image, line);
    const auto reading = recogniser.read(straight);
    const auto text = hc::vision::by_shape(straight, reading, upper_case);
    all.text += (all.text.empty() || text.empty() ? "" : " ") + text;
    all.confidence = std::min(all.confidence, reading.confidence);
  }
  return all;
}
