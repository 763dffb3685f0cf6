// SPDX-License-Identifier: Apache-2.0
#include "block.h"

#include <algorithm>
#include <limits>

namespace {

using namespace std::chrono_literals;

// Heights of capital letters to read a line at [px]: the network's errors differ between them.
constexpr int kHeights[] = {36, 30, 42};

/// Whether an image was cut out of another around a word or a line.
bool is_crop(const cv::Mat& image) {
  constexpr int kQqvga = 120, kQvga = 240;  // rows of the smallest images of cameras
  return image.rows < kQqvga || (image.rows < kQvga && image.cols >= 2 * image.rows);
}

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

BlockReader::Block BlockReader::find(const cv::Mat& image, double min_score) {
  if (!is_crop(image))
    return hc::vision::block_of_best(hc::vision::find_text_lines(image, min_score));
  constexpr double kLeastContrast = 8;  // standard deviation of grey values
  cv::Scalar mean, deviation;
  cv::meanStdDev(hc::vision::mean_of_channels(image), mean, deviation);
  if (deviation[0] < kLeastContrast) return {};
  const auto right = static_cast<float>(image.cols), bottom = static_cast<float>(image.rows);
  hc::vision::TextLine all;
  all.corners = {cv::Point2f(0, 0), {right, 0}, {right, bottom}, {0, bottom}};
  all.height = image.rows;
  return {all};
}

hc::vision::Reading BlockReader::read(const cv::Mat& image, const Block& block) {
  if (block.empty()) return {"", 0, {}};
  if (is_crop(image)) return recogniser_.read_crop(hc::vision::mean_of_channels(image));
  hc::vision::Reading all{"", 1, {}};
  for (const auto& line : block) {
    const auto reading = read_line(recogniser_, image, line, upper_case_);
    all.text += (all.text.empty() || reading.text.empty() ? "" : " ") + reading.text;
    all.confidence = std::min(all.confidence, reading.confidence);
  }
  return all;
}
