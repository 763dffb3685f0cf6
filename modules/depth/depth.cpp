// SPDX-License-Identifier: Apache-2.0
#include "depth.h"

#include <cmath>
#include <utility>

#include <vision/messages.h>

std::unique_ptr<hc::vision::StereoMatcher> DepthParameters::make_matcher() const {
  const hc::vision::StereoOptions options{static_cast<int>(*disparities),
                                          static_cast<int>(*speckle_size)};
  return *matcher == "opencv" ? hc::vision::opencv_matcher(options, static_cast<int>(*block_size))
                              : hc::vision::semi_global_matcher(options);
}

Depth::Depth(hc::Module& module) : module_(module) {
  module.on_start([this] { matcher_ = parameters_.make_matcher(); });
  module.on(intrinsics_, [this](const auto& message) { set_intrinsics(message.numbers()); });
  module.on(hc::together(left_, right_),
            [this](const hc::Message& left, const hc::Message& right) { match(left, right); });
}

void Depth::set_intrinsics(std::span<const double> numbers) {
  const bool is_pair = numbers.size() == 5 && std::isfinite(numbers[0]) && numbers[0] > 0 &&
                       std::isfinite(numbers[4]) && numbers[4] > 0;
  if (!is_pair) return module_.log("intrinsics: not fx, fy, cx, cy, baseline of a pair");
  measured_ = {.focal = numbers[0], .baseline = numbers[4], .cx = numbers[2], .cy = numbers[3]};
}

void Depth::match(const hc::Message& left, const hc::Message& right) {
  const auto& header = left.header;
  const cv::Mat left_mat = hc::value_or_drop(hc::as_mat(left));
  auto disparity = disparity_.loan(header.height, header.width);
  auto confidence = confidence_.loan(header.height, header.width);
  auto depth = depth_.loan(header.height, header.width);
  hc::vision::Disparities found{hc::as_mat(disparity), hc::as_mat(confidence)};
  const cv::Mat right_mat = hc::value_or_drop(hc::as_mat(right));
  if (auto matched = matcher_->match(left_mat, right_mat, found); !matched)
    throw hc::BadMessage(matched.error().detail);
  cv::Mat metres = hc::as_mat(depth);
  if (depth_.linked() || points_.linked())
    hc::vision::depth_of(found.disparity, geometry(header), metres);
  if (points_.linked()) send_points(metres, left_mat, header);
  disparity_.send(std::move(disparity));
  confidence_.send(std::move(confidence));
  depth_.send(std::move(depth));
}

void Depth::send_points(const cv::Mat& metres, const cv::Mat& left, const hc::Header& image) {
  auto draft = points_.loan(image.height, image.width);
  cv::Mat mat = hc::as_mat(draft);
  hc::vision::points_of(metres, left, geometry(image), mat);
  points_.send(std::move(draft));
}

hc::vision::StereoGeometry Depth::geometry(const hc::Header& image) {
  auto found = measured_;
  if (found.focal == 0) {
    found = {.focal = *parameters_.focal,
             .baseline = *parameters_.baseline,
             .cx = (image.width - 1) / 2.0,
             .cy = (image.height - 1) / 2.0};
    if (found.baseline == 0)
      found.baseline = frames_.fixed("left_eye", "right_eye").translation().norm();
  }
  found.offset = *parameters_.offset;
  return found;
}
