// SPDX-License-Identifier: Apache-2.0
#include <people/ssd.h>

#include <cmath>
#include <span>

#include <opencv2/imgproc.hpp>

#include <hc/base/format.h>

namespace hc::people {
namespace {

/// The middles of the cells of a grid, each as often as it has anchors.
void add_anchors(const Ssd::Grid& grid, const nets::Shape& image,
                 std::vector<cv::Point2f>& anchors) {
  const auto middle = [&](int i) {
    return (static_cast<float>(i) + 0.5F) * static_cast<float>(grid.side);
  };
  for (int y = 0; y < image[0] / grid.side; ++y)
    for (int x = 0; x < image[1] / grid.side; ++x)
      for (int i = 0; i < grid.anchors; ++i) anchors.emplace_back(middle(x), middle(y));
}

float sigmoid(float value) {
  return 1 / (1 + std::exp(-std::clamp(value, -100.F, 100.F)));
}

/// Whether what a network says of an anchor is in its image or beside it, which numbers of foreign
/// weights need not be, nor finite: what sorts and merges, and sizes of images, rely on it.
bool is_near(std::span<const float> numbers, const cv::Size& size) {
  constexpr float kFar = 2;  // sides
  const float most = kFar * static_cast<float>(std::max(size.width, size.height));
  return std::ranges::all_of(numbers, [&](float each) { return std::abs(each) <= most; });
}

/// A region of an image, scaled to a size of the same shape, u8 RGB; black outside of the image.
/// Its memory is bounded by the part that is inside, since an image may be a strip.
cv::Mat scaled(const cv::Mat& image, const cv::Rect2f& region, const cv::Size& size) {
  cv::Mat small = cv::Mat::zeros(size, CV_8UC3);
  const cv::Rect all({}, image.size()), inside = cv::Rect(region) & all;
  if (inside.empty()) return small;
  const float scale = static_cast<float>(size.width) / region.width;
  const bool is_smaller = scale < 0.7F;
  const cv::Point one(1, 1);  // what interpolation takes beyond the region
  const cv::Rect shown = is_smaller ? inside : cv::Rect(inside.tl() - one, inside.br() + one) & all;
  cv::Mat colour = image(shown);
  if (image.channels() == 1) cv::cvtColor(colour, colour, cv::COLOR_GRAY2RGB);
  const cv::Point2f from = (cv::Point2f(shown.tl()) - region.tl()) * scale;
  if (is_smaller) {
    const cv::Point2f extent = cv::Point2f(shown.size()) * scale;
    // Rounded pixels may be one beyond the edge.
    const cv::Rect to = cv::Rect(cv::Point(from), cv::Point(from + extent)) & cv::Rect({}, size);
    if (to.empty()) return small;
    // By halves as long as interpolation would skip pixels: in a fifth of the time of exact means.
    while (colour.cols >= 2 * to.width && colour.rows >= 2 * to.height)
      cv::resize(colour, colour, colour.size() / 2, 0, 0, cv::INTER_AREA);
    cv::resize(colour, small(to), to.size(), 0, 0, cv::INTER_LINEAR);
  } else {
    const float half = (scale - 1) / 2;  // pixel
    const cv::Matx23f to_small(scale, 0, from.x + half, 0, scale, from.y + half);
    cv::warpAffine(colour, small, to_small, size, cv::INTER_LINEAR);
  }
  return small;
}

/// A region of the shape of a size, with a part in its middle.
cv::Rect2f region_around(const cv::Rect2f& part, const cv::Size2f& size) {
  const float scale = std::max(part.width / size.width, part.height / size.height);
  const cv::Size2f region = size * scale, beyond = region - part.size();
  return {part.tl() - cv::Point2f(beyond) / 2, region};
}

}  // namespace

Result<Ssd> Ssd::make(std::unique_ptr<nets::Network> network, std::initializer_list<Grid> grids,
                      std::size_t points, Range range, std::string_view what) {
  std::vector<cv::Point2f> anchors;
  const auto& input = network->input();
  const auto refused = [&] {
    return Error{Code::Malformed, hc::format("not a network that finds {}: its input is {}", what,
                                             nets::text(input))};
  };
  if (input.size() != 3 || input[2] != 3) return refused();
  for (const Grid& grid : grids) add_anchors(grid, input, anchors);
  if (anchors.empty()) return refused();
  const auto outputs = network->run(cv::Mat::zeros(input[0], input[1], CV_32FC3));
  const auto count = static_cast<int>(anchors.size());
  const auto numbers = static_cast<int>(4 + 2 * points);
  const bool fits = outputs.size() == 2 && outputs[0].rows == count && outputs[0].cols == numbers &&
                    outputs[1].rows == count && outputs[1].cols == 1;
  if (!fits) return refused();
  return Ssd(std::move(network), std::move(anchors), range);
}

std::vector<Ssd::Candidate> Ssd::candidates(const cv::Mat& image, const cv::Rect& part,
                                            float least) {
  const cv::Rect2f region = region_around(part, size_);
  const float scale = region.width / static_cast<float>(size_.width);
  cv::Mat input;
  scaled(image, region, size_)
      .convertTo(input, CV_32F, (range_.white - range_.black) / 255.0, range_.black);
  outputs_ = network_->run(input);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const auto row = static_cast<int>(i);
    const float score = sigmoid(outputs_[1].at<float>(row, 0));
    const auto* numbers = outputs_[0].ptr<float>(row);
    const auto count = static_cast<std::size_t>(outputs_[0].cols);
    if (!(score >= least) || !is_near({numbers, count}, size_)) continue;
    candidates.push_back({score, numbers, region.tl() + anchors_[i] * scale, scale});
  }
  return candidates;
}

}  // namespace hc::people
