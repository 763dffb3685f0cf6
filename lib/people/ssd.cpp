// SPDX-License-Identifier: Apache-2.0
#include <people/ssd.h>

#include <cmath>
#include <span>

#include <opencv2/imgproc.hpp>

#include <hc/base/format.h>

namespace hc::people {
namespace {

/// The middles of the cells of a grid, each as often as it has anchors.
void add_anchors(const Ssd::Grid& grid, std::vector<cv::Point2f>& anchors) {
  const auto middle = [&](int i) {
    return (static_cast<float>(i) + 0.5F) / static_cast<float>(grid.cells);
  };
  for (int y = 0; y < grid.cells; ++y)
    for (int x = 0; x < grid.cells; ++x)
      for (int i = 0; i < grid.anchors; ++i) anchors.emplace_back(middle(x), middle(y));
}

float sigmoid(float value) {
  return 1 / (1 + std::exp(-std::clamp(value, -100.F, 100.F)));
}

/// Whether what a network says of an anchor is in its image or beside it, which numbers of foreign
/// weights need not be, nor finite: what sorts and merges, and sizes of images, rely on it.
bool is_near(std::span<const float> numbers, int side) {
  constexpr float kFar = 2;  // sides
  const float most = kFar * static_cast<float>(side);
  return std::ranges::all_of(numbers, [&](float each) { return std::abs(each) <= most; });
}

/// A square of an image as the network takes it, f32; black outside of the image.
cv::Mat input_of(const cv::Mat& image, const cv::Rect2f& square, int side, Ssd::Range range) {
  const float scale = static_cast<float>(side) / square.width;
  const cv::Matx23f to_input(scale, 0, (0.5F - square.x) * scale - 0.5F, 0, scale,
                             (0.5F - square.y) * scale - 0.5F);
  cv::Mat rgb;
  if (image.channels() == 1) cv::cvtColor(image, rgb, cv::COLOR_GRAY2RGB);
  const cv::Mat& colour = image.channels() == 1 ? rgb : image;
  cv::Mat small, input;
  if (scale < 0.7F) {  // means of pixels
    const cv::Rect all = cv::Rect(square) & cv::Rect(0, 0, image.cols, image.rows);
    cv::Mat squared(static_cast<int>(square.height), static_cast<int>(square.width), CV_8UC3,
                    cv::Scalar::all(0));
    colour(all).copyTo(squared(all - cv::Point(square.tl())));
    cv::resize(squared, small, {side, side}, 0, 0, cv::INTER_AREA);
  } else {
    cv::warpAffine(colour, small, to_input, {side, side}, cv::INTER_LINEAR);
  }
  small.convertTo(input, CV_32F, (range.white - range.black) / 255.0, range.black);
  return input;
}

cv::Rect2f square_around(const cv::Rect& part) {
  const int side = std::max(part.width, part.height);
  const cv::Size beyond = (cv::Size(side, side) - part.size()) / 2;
  return cv::Rect(part.x - beyond.width, part.y - beyond.height, side, side);
}

}  // namespace

Result<Ssd> Ssd::make(std::unique_ptr<nets::Network> network, std::initializer_list<Grid> grids,
                      std::size_t points, Range range, std::string_view what) {
  std::vector<cv::Point2f> anchors;
  for (const Grid& grid : grids) add_anchors(grid, anchors);
  const auto& input = network->input();
  const auto refused = [&] {
    return Error{Code::Malformed, hc::format("not a network that finds {}: its input is {}", what,
                                             nets::text(input))};
  };
  if (anchors.empty() || input.size() != 3 || input[0] != input[1] || input[2] != 3)
    return refused();
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
  const cv::Rect2f square = square_around(part);
  const int side = network_->input()[0];
  outputs_ = network_->run(input_of(image, square, side, range_));
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const auto row = static_cast<int>(i);
    const float score = sigmoid(outputs_[1].at<float>(row, 0));
    const auto* numbers = outputs_[0].ptr<float>(row);
    const auto count = static_cast<std::size_t>(outputs_[0].cols);
    if (!(score >= least) || !is_near({numbers, count}, side)) continue;
    candidates.push_back({score, numbers, square.tl() + anchors_[i] * square.width,
                          square.width / static_cast<float>(side)});
  }
  return candidates;
}

}  // namespace hc::people
