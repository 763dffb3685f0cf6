// SPDX-License-Identifier: Apache-2.0
#include "camera.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <vision/image.h>
#include <vision/messages.h>
#include <opencv2/imgproc.hpp>

#include "devices.h"

namespace {

using namespace std::chrono_literals;

constexpr auto kLongestPause = 10s;  // between images of a video, as of `hc play`

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
  const Reading reading{
      parameters_.is_upright(),
      [this](const char* kind, const std::string& line) { module_.log_once(kind, line); }};
  if (parameters_.is_pair())
    files_ = open_sequences(*parameters_.source, *parameters_.right_source, reading);
  else
    files_.left = open_sequence(*parameters_.source, reading);
  if (!files_.remark.empty()) module_.log(files_.remark, hc::Level::Warning);
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
  if (files_.left->length()) return take_video();
  if (*parameters_.rate > 0) module_.keep_rate(*parameters_.rate);
  const cv::Mat left = next(*files_.left).image;
  const hc::Time time = module_.now();
  const cv::Mat right = files_.right ? next(*files_.right).image : cv::Mat();
  if (left.empty() || (files_.right && right.empty())) return module_.stop();
  send_both(left, right, time);
}

/// A reader that is slow delays images, but does not change their times.
void Camera::take_video() {
  if (!start_) start_ = {module_.now(), module_.monotonic()};
  auto images = next_of_video();
  if (!images && *parameters_.loop) {
    start_video_again();
    images = next_of_video();
  }
  if (!images) return module_.stop();
  const auto& [left, right] = *images;
  const auto pause = left.time - shown_.value_or(left.time);
  shown_ = left.time;
  if (*parameters_.paced && pause > kLongestPause) {
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(pause);
    module_.log("skipping a pause of " + std::to_string(seconds.count()) + " s in the video");
    start_->monotonic -= pause;
  }
  if (!thinning_.takes(left.time, *parameters_.rate)) return;
  if (*parameters_.paced) module_.wait_until(start_->monotonic + (left.time - start_->time));
  send_both(left.image, right.image, left.time);
}

/// The next image of a video, or the next two of two videos that have nearly the same time; none at
/// the end.
std::optional<std::array<Frame, 2>> Camera::next_of_video() {
  const auto frame_of = [&](ImageSequence& file) {
    const auto [image, at] = file.next();
    return Frame{image, start_->time + at.value_or(0ns)};
  };
  if (!files_.right || !files_.right->length()) {
    std::array<Frame, 2> images{frame_of(*files_.left), {}};
    if (files_.right) images[1].image = next(*files_.right).image;
    if (images[0].image.empty() || (files_.right && images[1].image.empty())) return {};
    return images;
  }
  while (true) {
    if (auto pair = pairing_.take()) return pair;
    const std::size_t behind = last_[0] <= last_[1] ? 0 : 1;
    auto frame = frame_of(behind == 0 ? *files_.left : *files_.right);
    if (frame.image.empty()) return {};
    last_.at(behind) = frame.time;
    pairing_.add(behind, std::move(frame));
  }
}

/// Two videos start again together.
void Camera::start_video_again() {
  auto length = *files_.left->length();
  files_.left->rewind();
  if (files_.right) {
    length = std::max(length, files_.right->length().value_or(0ns));
    files_.right->rewind();
  }
  start_->time += length;
  start_->monotonic += length;
  pairing_ = {};
}

SequenceImage Camera::next(ImageSequence& file) const {
  auto image = file.next();
  if (!image.image.empty() || !*parameters_.loop) return image;
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
