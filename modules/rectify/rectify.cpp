// SPDX-License-Identifier: Apache-2.0
#include "rectify.h"

#include <array>
#include <utility>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <vision/messages.h>

using hc::Coord, hc::vision::Eye, hc::vision::Rectifier;

Rectify::Rectify(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(head_, [this](const auto& message) { mount(message); });
  module.on(hc::together(left_, right_),
            [this](const auto& first, const auto& second) { rectify(first, second); });
  module.every(std::chrono::seconds(1), [this] { send_intrinsics(); });
}

void Rectify::start() {
  const auto& file = parameters_.calibration_file;
  if (file->empty()) return;
  calibration_ = hc::value_or_refuse(file, hc::vision::read_calibration(*file));
  if (!calibration_->head.empty())
    mounting_.calibration =
        hc::value_or_refuse(file, hc::gaze::HeadCalibration::of(calibration_->head));
}

void Rectify::mount(const hc::MessageOf<hc::TableKind<double>>& message) {
  const auto found = hc::gaze::HeadCalibration::of(message.numbers());
  if (!found) return module_.log_once("invalid calibration", found.error().detail);
  if (mounting_.is_of_message && found->numbers() == mounting_.calibration.numbers())
    return;  // sent repeatedly
  mounting_ = {*found, true};
  is_new_ = true;
  for (auto& rectifier : rectifiers_) rectifier.reset();
}

void Rectify::rectify(const Image& first, const Image& second) {
  if (first.header.empty() || second.header.empty()) return;
  const std::array images = {mounting_.calibration.swapped ? &second : &first,
                             mounting_.calibration.swapped ? &first : &second};
  prepare(Eye::Left, images[0]->header);
  prepare(Eye::Right, images[1]->header);
  time_ = first.header.time;
  if (std::exchange(is_new_, false)) send_intrinsics();
  std::array drafts = {left_rectified_.loan(images[0]->header.height, images[0]->header.width),
                       right_rectified_.loan(images[1]->header.height, images[1]->header.width)};
  cv::parallel_for_({0, 2}, [&](const cv::Range& eyes) {
    for (auto eye = static_cast<std::size_t>(eyes.start); eye < static_cast<std::size_t>(eyes.end);
         ++eye)
      hc::fill(drafts[eye],
               [&](cv::Mat& mat) { rectifiers_[eye]->rectify(hc::as_mat(*images[eye]), mat); });
  });
  left_rectified_.send(std::move(drafts[0]));
  right_rectified_.send(std::move(drafts[1]));
}

void Rectify::prepare(Eye eye, const hc::Header& header) {
  const cv::Size size(header.width, header.height);
  auto& rectifier = rectifiers_[eye == Eye::Left ? 0 : 1];
  if (rectifier && rectifier->size() == size) return;
  if (parameters_.calibration_file->empty()) calibration_ = ideal_pair(size);
  if (calibration_->size.area() == 0) calibration_->size = size;
  if (mounting_.is_of_message)
    hc::vision::turn(*calibration_, mounting_.calibration.R_left_right());
  rectifier = hc::value_or_drop(Rectifier::make(*calibration_, eye, size));
}

hc::vision::StereoCalibration Rectify::ideal_pair(const cv::Size& size) {
  const double baseline = frames_.fixed("left_eye", "right_eye").translation().norm();
  const double focal = assumed_.focal(*parameters_.focal, size.width,
                                      frames_.are_given() ? std::nullopt : std::optional(baseline));
  if (!calibration_)
    module_.log(
        hc::format("without a calibration file: for two equal eyes {:.3f} m apart, with a "
                   "focal length of {} px",
                   baseline, focal));
  return hc::vision::ideal_pair(size, focal, baseline);
}

void Rectify::send_intrinsics() {
  if (!time_) return;
  send_cameras();
  const auto camera = calibration_->rectified();
  intrinsics_.send({camera.fx, camera.fy, camera.cx, camera.cy, calibration_->baseline()}, *time_);
}

void Rectify::send_cameras() {
  if (!cameras_.linked()) return;
  hc::gaze::Eyes eyes(frames_.fixed("head", "left_eye"), frames_.fixed("head", "right_eye"));
  eyes.set_baseline(calibration_->baseline());
  if (mounting_.is_of_message || !calibration_->head.empty()) eyes.calibrate(mounting_.calibration);
  Eigen::Isometry3d T_left_rectified = Eigen::Isometry3d::Identity();
  T_left_rectified.linear() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(calibration_->R1.val)
          .transpose();
  cameras_.send(hc::numbers_of(eyes.T_head_eye(hc::gaze::Side::Left)), *time_,
                hc::transform_coord(Coord::kHead, Coord::kLeftEye));
  cameras_.send(hc::numbers_of(T_left_rectified), *time_,
                hc::transform_coord(Coord::kLeftEye, Coord::kLeftRectified));
}
