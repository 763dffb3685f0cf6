// SPDX-License-Identifier: Apache-2.0
#include <people/embedding.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include <opencv2/imgproc.hpp>

#include <people/warp.h>

namespace hc::people {
namespace {

constexpr int kSide = 150;  // of a chip [px]
/// Where the eyes, the nose and the mouth of a mean face are in a chip: dlib's mean face, with a
/// border of a quarter of its size around it. Source: dlib, image_transforms/interpolation.h.
constexpr float kPlaces[][2] = {{47.8F, 47.1F}, {100.3F, 47.1F}, {74.0F, 82.0F}, {74.0F, 105.0F}};
constexpr Face::Point kPoints[] = {Face::RightEye, Face::LeftEye, Face::Nose, Face::Mouth};

}  // namespace

bool is_embedding(const Embedding& numbers) {
  constexpr float kMost = 10;
  return std::ranges::all_of(numbers, [](float each) { return std::abs(each) < kMost; });
}

float distance(const Embedding& a, const Embedding& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

cv::Mat face_chip(const cv::Mat& image, const Face& face) {
  // The similarity (a -b; b a) with the least squares between points and places.
  cv::Point2f from, to;
  for (std::size_t i = 0; i < std::size(kPoints); ++i) {
    from += face.points[kPoints[i]] / static_cast<float>(std::size(kPoints));
    to += cv::Point2f(kPlaces[i][0], kPlaces[i][1]) / static_cast<float>(std::size(kPoints));
  }
  float along = 0, across = 0, spread = 0;
  for (std::size_t i = 0; i < std::size(kPoints); ++i) {
    const cv::Point2f p = face.points[kPoints[i]] - from;
    const cv::Point2f q = cv::Point2f(kPlaces[i][0], kPlaces[i][1]) - to;
    along += p.dot(q);
    across += p.x * q.y - p.y * q.x;
    spread += p.dot(p);
  }
  if (!(spread > 0)) return cv::Mat::zeros(kSide, kSide, CV_8UC3);
  const float a = along / spread, b = across / spread;
  const cv::Matx23d to_chip(a, -b, to.x - a * from.x + b * from.y, b, a,
                            to.y - b * from.x - a * from.y);
  cv::Matx23d to_image;
  cv::invertAffineTransform(to_chip, to_image);
  cv::Mat chip = warped(image, to_image, kSide, cv::BORDER_CONSTANT);
  if (chip.channels() == 1) cv::cvtColor(chip, chip, cv::COLOR_GRAY2RGB);
  return chip;
}

Result<Identifier> Identifier::make(std::unique_ptr<nets::Network> network) {
  if (network->input() != nets::Shape{kSide, kSide, 3})
    return Error{Code::Malformed, "not a network that identifies faces: its input is " +
                                      nets::text(network->input())};
  const auto outputs = network->run(cv::Mat(kSide, kSide, CV_32FC3, cv::Scalar::all(0)));
  if (outputs.size() != 1 || outputs[0].total() != std::tuple_size_v<Embedding>)
    return Error{Code::Malformed,
                 "not a network that identifies faces: it does not give 128 numbers"};
  return Identifier(std::move(network));
}

std::optional<Embedding> Identifier::describe(const cv::Mat& image, const Face& face) {
  cv::Mat input;
  face_chip(image, face).convertTo(input, CV_32F, 1 / 256.0);
  input -= cv::Scalar(122.782, 117.001, 104.298) / 256;  // Source: dlib, input_rgb_image_sized
  const auto outputs = network_->run(input);
  Embedding embedding;
  std::copy_n(outputs[0].begin<float>(), embedding.size(), embedding.begin());
  if (!is_embedding(embedding)) return std::nullopt;
  return embedding;
}

}  // namespace hc::people
