// SPDX-License-Identifier: Apache-2.0
#include "camera.h"

#include <chrono>
#include <utility>
#include <vector>

#include <vision/image.h>
#include <vision/messages.h>
#include <opencv2/imgproc.hpp>

#include "devices.h"

namespace {

void require(bool is_valid, const std::string& problem) {
  if (!is_valid) throw hc::ModuleError(hc::Error{hc::Code::Invalid, problem});
}

}  // namespace

void CameraParameters::check() const {
  require(!source->empty(),
          "no source given: a camera's number, /dev/videoN or aravis:, a video, a folder or an "
          "image; see --help");
  require(!is_pair() || !*side_by_side, "side_by_side and right_source exclude each other");
  require(!is_pair() || is_live(*source) == is_live(*right_source),
          "a camera and a file cannot be the two eyes");
}

Camera::Camera(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.generate([this] { generate(); });
}

void Camera::start() {
  parameters_.check();
  if (is_live(*parameters_.source)) return open_live();
  left_file_ = open_sequence(*parameters_.source);
  if (parameters_.is_pair()) right_file_ = open_sequence(*parameters_.right_source);
}

void Camera::open_live() {
  const auto& given = parameters_;
  const CaptureMode mode{static_cast<int>(*given.width) * (*given.side_by_side ? 2 : 1),
                         static_cast<int>(*given.height), *given.rate, *given.pixel_format};
  std::vector<LiveCamera> live{live_camera(*given.source, mode)};
  if (given.is_pair()) live.push_back(live_camera(*given.right_source, mode));
  cameras_ = std::make_unique<LiveCameras>(std::move(live), *given.reopen,
                                           Adjustment{*given.exposure, *given.gain});
}

void Camera::generate() {
  if (*parameters_.count > 0 && sent_ == *parameters_.count) return module_.stop();
  if (cameras_ != nullptr)
    take_live();
  else
    take_files();
}

void Camera::take_live() {
  constexpr std::chrono::milliseconds kTimeout{20};  // maximum delay of commands
  cameras_->adjust({*parameters_.exposure, *parameters_.gain});
  auto taken = cameras_->next(kTimeout);
  for (const auto& [level, line] : cameras_->remarks()) module_.log(line, level);
  if (!taken) throw hc::ModuleError(taken.error().detail);
  if (!*taken) return;
  const auto& [left, right] = **taken;
  // Both images of a pair get the same time, so that they match downstream.
  const hc::Time time = left ? left->time : right->time;
  if (thinning_.takes(time, *parameters_.rate))
    send_both(left ? left->image : cv::Mat(), right ? right->image : cv::Mat(), time);
}

void Camera::take_files() {
  if (*parameters_.rate > 0) module_.keep_rate(*parameters_.rate);
  const cv::Mat left = next(*left_file_);
  const hc::Time time = module_.now();
  const cv::Mat right = right_file_ ? next(*right_file_) : cv::Mat();
  if (left.empty() || (right_file_ && right.empty())) return module_.stop();
  send_both(left, right, time);
}

cv::Mat Camera::next(ImageSequence& file) const {
  cv::Mat image = file.next();
  if (!image.empty() || !*parameters_.loop) return image;
  file.rewind();
  return file.next();
}

void Camera::send_both(cv::Mat left, cv::Mat right, hc::Time time) {
  using hc::Coord;
  if (*parameters_.side_by_side) {
    const int half = left.cols / 2;
    right = left.colRange(half, 2 * half);
    left = left.colRange(0, half);
  }
  const bool is_rectified = *parameters_.rectified;
  send(left_, left, time, is_rectified ? Coord::kLeftRectified : Coord::kLeftImage);
  send(right_, right, time, is_rectified ? Coord::kRightRectified : Coord::kRightImage);
  ++sent_;
}

void Camera::send(Images& output, const cv::Mat& image, hc::Time time, std::int32_t coord) {
  if (image.empty()) return;
  const auto& given = parameters_;
  const cv::Mat fitted = hc::vision::fit(image, static_cast<int>(*given.width),
                                         static_cast<int>(*given.height), *given.smooth);
  auto draft = output.loan(fitted.rows, fitted.cols);
  draft.header.time = *given.stamped ? time : hc::Time();
  draft.header.coord = coord;
  hc::fill(draft, [&](cv::Mat& rgb) { cv::cvtColor(fitted, rgb, cv::COLOR_BGR2RGB); });
  output.send(std::move(draft));
}
