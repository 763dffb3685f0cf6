// SPDX-License-Identifier: Apache-2.0
#include "calibrator.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <hc/os/program.h>
#include <vision/messages.h>
#include <opencv2/imgproc.hpp>

using hc::gaze::Angles, hc::gaze::HeadCalibration;

Calibrator::Calibrator(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(hc::together(left_, right_), [this](const auto& one, const auto& other) {
    const hc::Time time = module_.time_of(one.header);
    frames_.when_known("robot", "head", time, [this, time, one, other](const auto& T_robot_head) {
      if (!T_robot_head)
        return module_.log_once("without a pose of the head",
                                "images dropped: " + T_robot_head.error().detail);
      look(time, hc::gaze::angles_of(Eigen::Quaterniond(T_robot_head->linear())), one, other);
    });
  });
  module.every(std::chrono::milliseconds(50), [this] { steer(); });
  module.every(std::chrono::seconds(1), [this] {
    if (found_) publish();
  });
  // When the images end, the result is still published; when asked to stop, it is discarded.
  module.on_end([this] {
    if (computes() && !hc::stop_requested()) take();
  });
}

void Calibrator::start() {
  mounted_.emplace(frames_.fixed("head", "left_eye"), frames_.fixed("head", "right_eye"));
  tour_.emplace(*parameters_.turn);
  const auto& file = parameters_.calibration_file;
  if (file->empty() || !std::filesystem::exists(*file)) return;
  read_ = hc::value_or_refuse(file, hc::vision::read_calibration(*file));
  cameras_ = *read_;
  if (!cameras_.head.empty())
    finish(hc::value_or_refuse(file, HeadCalibration::of(cameras_.head)), "from " + *file + ": ");
}

void Calibrator::look(hc::Time time, const Angles& measured, const hc::Message& one,
                      const hc::Message& other) {
  last_pair_ = module_.now();
  if (attempts_.are_over || computes() || !tour_->rests(time, measured)) return;
  HeadView view;
  view.unit = measured;
  cv::cvtColor(hc::value_or_drop(hc::as_mat(one)), view.first, cv::COLOR_RGB2GRAY);
  cv::cvtColor(hc::value_or_drop(hc::as_mat(other)), view.second, cv::COLOR_RGB2GRAY);
  const cv::Size size = view.first.size();
  hc::succeed_or_drop(tour_->add(std::move(view)));
  if (cameras_.M1(0, 0) == 0)
    cameras_ = hc::vision::ideal_pair(size, assumed_.focal(*parameters_.focal, size.width),
                                      mounted_->baseline());
  if (cameras_.size.area() == 0) cameras_.size = size;
  attempts_.sent = {};
  if (tour_->is_complete()) compute();
}

void Calibrator::compute() {
  mounted_->set_baseline(cameras_.baseline());
  computation_.result = std::async(std::launch::async, calibrate, tour_->restart(), cameras_,
                                   *mounted_, computation_.stop.get_token());
}

void Calibrator::take() {
  const auto calibration = computation_.result.get();
  if (!calibration) return fail(calibration.error().detail);
  finish(*calibration, "");
  const auto& file = *parameters_.calibration_file;
  if (file.empty()) return;
  if (hc::vision::has_changed(file, read_))
    return module_.log(file +
                       " is kept: another program has written it since the start; start again");
  hc::vision::turn(cameras_, calibration->R_left_right());
  const auto numbers = calibration->numbers();
  cameras_.head.assign(numbers.begin(), numbers.end());
  if (auto written = hc::vision::write_calibration(file, cameras_); !written)
    module_.log(file + " stays as it was: " + written.error().detail, hc::Level::Error);
}

void Calibrator::steer() {
  using std::chrono_literals::operator""ms;
  constexpr std::chrono::seconds kSilent{1};  // without a pair for longer: disconnected
  const hc::Time now = module_.now();
  if (computes() && computation_.result.wait_for(0ms) == std::future_status::ready) take();
  // Bids for the head only while images of both eyes arrive with a known head pose.
  const bool sees = now - last_pair_ < kSilent;
  const bool wants = !attempts_.are_over && now >= attempts_.paused_until && (sees || computes());
  bid_.send(wants ? *parameters_.salience : 0.0, now);
  if (!wants) {
    attempts_.sent = {};
    return;
  }
  const auto& wanted = computes() ? tour_->last() : tour_->next();
  if (attempts_.sent == hc::Time()) attempts_.sent = now;
  if (!computes() && hc::seconds(now - attempts_.sent) > *parameters_.timeout)
    return fail("the head did not come to rest at the commanded pose");
  command_.send({0.0, wanted.tilt, wanted.pan}, now);
}

void Calibrator::finish(const HeadCalibration& calibration, const std::string& how) {
  attempts_.are_over = true;
  found_ = {calibration,
            how.empty() ? "by turning the head" : "from " + *parameters_.calibration_file};
  publish();
  constexpr double kDegrees = 180 / M_PI;
  const auto& zero = calibration.zero;
  const auto& offset = calibration.offset;
  module_.log(hc::format(
      "{}cameras {}; gaze offset pan {:.2f}°, tilt {:.2f}°; right-to-left rotation "
      "roll {:.2f}°, pitch {:.2f}°, yaw {:.2f}°",
      how, calibration.swapped ? "swapped" : "not swapped", zero.pan * kDegrees,
      zero.tilt * kDegrees, offset.z() * kDegrees, offset.x() * kDegrees, offset.y() * kDegrees));
}

void Calibrator::fail(const std::string& why) {
  tour_->restart();
  attempts_.sent = {};
  attempts_.are_over = ++attempts_.failed >= *parameters_.tries;
  attempts_.paused_until = hc::later(module_.now(), hc::duration(*parameters_.pause));
  module_.log("not calibrated: " + why + (attempts_.are_over ? "; giving up" : "; retrying"));
}

void Calibrator::publish() {
  const auto numbers = found_->calibration.numbers();
  result_.send(std::span(numbers));
}

void Calibrator::log_result() const {
  if (found_)
    module_.log("eye mounting calibrated " + found_->how, hc::Level::Result);
  else if (attempts_.failed > 0)
    module_.log("eye mounting not found", hc::Level::Result);
}
