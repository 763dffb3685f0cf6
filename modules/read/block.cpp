// SPDX-License-Identifier: Apache-2.0
#include "block.h"

#include <algorithm>
#include <limits>

namespace {

using namespace std::chrono_literals;

// Heights of capital letters to read a line at [px]: the network's errors differ between them.
constexpr int kHeights[] = {36, 30, 42};

/// Reads a line, at several sizes until the letters match the shapes of the glyphs.
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

BlockReader::BlockReader(Recogniser recogniser, bool upper_case)
    : recogniser_(std::move(recogniser)), upper_case_(upper_case) {}

hc::Result<BlockReader> BlockReader::make(const std::string& language, bool upper_case) {
  auto recogniser = HC_TRY(Recogniser::make(language, upper_case));
  return BlockReader(std::move(recogniser), upper_case);
}

bool BlockReader::is_due(hc::Time time, double rate) const {
  if (rate <= 0 || !read_at_) return true;
  const auto since = time - *read_at_;
  // Tolerates 0.5 ms of jitter in the times of images.
  return since < 0s || since >= hc::duration(1 / rate) - 500us;
}

std::optional<hc::vision::Reading> BlockReader::read_when_due(const cv::Mat& image,
                                                              const Block& block, hc::Time time,
                                                              double rate) {
  if (!hc::vision::is_whole(block) || !is_due(time, rate)) return std::nullopt;
  read_at_ = time;
  return read(image, block);
}

hc::vision::Reading BlockReader::read(const cv::Mat& image, const Block& block) {
  hc::vision::Reading all{"", 1, {}};
  for (const auto& line : block) {
    const auto reading = read_line(recogniser_, image, line, upper_case_);
    all.text += (all.text.empty() || reading.text.empty() ? "" : " ") + reading.text;
    all.confidence = std::min(all.confidence, reading.confidence);
  }
  return all;
}
