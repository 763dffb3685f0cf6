// SPDX-License-Identifier: Apache-2.0
#include "depth.h"

#include <algorithm>
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
  module.on(hc::together(left_, right_), [this](const hc::Message& left, const hc::Message& right) {
    if (!pair_.is_awaited()) return match(left, right);
    pair_.when_known([this, l = left.keep(), r = right.keep()] { match(l, r); });
  });
  module.on_end([this] { pair_.answer_all(); });
}

void Depth::match(const hc::Message& left, const hc::Message& right) {
  const auto& header = left.header;
  const cv::Mat left_mat = hc::value_or_drop(hc::as_mat(left));
  auto disparity = disparity_.loan(header.height, header.width);
  auto confidence = confidence_.loan(header.height, header.width);
  auto depth = depth_.loan(header.height, header.width);
  disparity.header.time = confidence.header.time = depth.header.time =
      std::max(header.time, right.header.time);
  hc::vision::Disparities found{hc::as_mat(disparity), hc::as_mat(confidence), right_disparity_};
  const cv::Mat right_mat = hc::value_or_drop(hc::as_mat(right));
  const auto eyes = right_depth_.linked() ? hc::vision::Eyes::Both : hc::vision::Eyes::Left;
  if (auto matched = matcher_->match(left_mat, right_mat, found, eyes); !matched)
    throw hc::BadMessage(matched.error().detail);
  cv::Mat metres = hc::as_mat(depth);
  if (depth_.linked() || points_.linked())
    hc::vision::depth_of(found.disparity, geometry(header), metres);
  if (points_.linked()) send_points(metres, left_mat, header);
  disparity_.send(std::move(disparity));
  confidence_.send(std::move(confidence));
  depth_.send(std::move(depth));
  if (eyes == hc::vision::Eyes::Both) send_right_depth(found.right, header);
}

void Depth::send_right_depth(const cv::Mat& disparity, const hc::Header& image) {
  right_disparity_ = disparity;
  auto draft = right_depth_.loan(image.height, image.width);
  draft.header.time = image.time;
  cv::Mat metres = hc::as_mat(draft);
  hc::vision::depth_of(disparity, geometry(image), metres);
  right_depth_.send(std::move(draft));
}

void Depth::send_points(const cv::Mat& metres, const cv::Mat& left, const hc::Header& image) {
  auto draft = points_.loan(image.height, image.width);
  draft.header.time = image.time;
  cv::Mat mat = hc::as_mat(draft);
  hc::vision::points_of(metres, left, geometry(image), mat);
  points_.send(std::move(draft));
}

hc::vision::StereoGeometry Depth::geometry(const hc::Header& image) {
  const auto pair = pair_.of(image.width, image.height);
  return {.focal = pair.fx,
          .baseline = pair.baseline,
          .offset = *parameters_.offset,
          .cx = pair.cx,
          .cy = pair.cy};
}
