// SPDX-License-Identifier: Apache-2.0
#include "gaze.h"

#include <cmath>

#include <frames/messages.h>
#include <hc/base/format.h>

#include "seen.h"

namespace {

/// Period of commands while a stick is pushed; the first may precede the focus.
constexpr std::chrono::milliseconds kSteer{5};

/// Messages further in the future, from a skewed clock, are dropped [s].
constexpr double kAhead = 0.2;

/// Frame of a setpoint: the robot's for angles of the neck (13) or a person's head (14), or if 0.
std::int32_t frame_of_setpoint(std::int32_t coord) {
  const bool is_of_neck =
      coord == 0 || coord == hc::Coord::kGaze || coord == hc::Coord::kSupervisor;
  return is_of_neck ? kRobot : coord;
}

}  // namespace

Gaze::Gaze(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(calibration_, [this](const auto& message) { calibrate(message); });
  module.on(target_, [this](const hc::Message& message) { see(message); });
  module.on(setpoint_, [this](const auto& message) { set(message); });
  module.on(stick_, [this](const auto& message) { push(message); });
  module.every(parameters_.rate, [this] { follow(); });
  module.every(kSteer, [this] { steer(); });
  module.every(std::chrono::milliseconds(100), [this] { send_bid(); });
}

void Gaze::start() {
  sets_.emplace(hc::duration(*parameters_.timeout));
  controller_.emplace(parameters_, Targets(parameters_.eyes(frames_.fixed(kHead, kLeftEye),
                                                            frames_.fixed(kHead, kRightEye)),
                                           parameters_.follower(), *parameters_.distance));
  const auto& file = parameters_.calibration_file;
  if (file->empty()) return;
  const auto read = hc::value_or_refuse(file, hc::vision::read_calibration(*file));
  if (const auto used = controller_->targets.calibrate(read); !used)
    hc::refuse(file, used.error().detail);
}

void Gaze::calibrate(const hc::MessageOf<hc::TableKind<double>>& message) {
  auto found = hc::gaze::HeadCalibration::of(message.matrix().numbers());
  if (!found) return module_.log("calibration: " + found.error().detail);
  controller_->targets.calibrate(*found);
}

void Gaze::see(const hc::Message& message) {
  const auto seen = seen_of(message);
  if (!seen) return;
  const auto time = time_of(message.header, *parameters_.timeout);
  const std::int32_t frame = Targets::frame_of(seen->coord);
  check_frame(frame, "an eye and its image (4, 5, 7, 8)");
  // The eyes share one target, but two sources with the same eye see different ones.
  auto& turn = sights_.try_emplace(seen->coord, hc::duration(*parameters_.timeout)).first->second;
  if (!has_turn("target", turn, message.header.src)) return;
  if (seen->coord == kLeftImage || seen->coord == kRightImage) check_camera();
  frames_.when_known(kRobot, frame, time, [this, time, frame, seen](const auto& T_robot_frame) {
    controller_->targets.see(time, seen->coord, seen->p,
                             T_robot_frame ? *T_robot_frame : frames_.nearest(kRobot, frame, time));
    follow();
  });
}

void Gaze::check_camera() {
  if (parameters_.has_camera()) return;
  const auto& eyes = controller_->targets.eyes();
  assumed_.say(
      hc::format("focal = {}, cx = {}, cy = {} px; of these, those that are not set are the "
                 "default head's",
                 eyes.focal, eyes.cx, eyes.cy));
}

void Gaze::set(const hc::MessageOf<hc::RotationKind<double>>& message) {
  const auto& header = message.header;
  const auto q = hc::value_or_drop(hc::rotation_of(message));
  const auto time = time_of(header, *parameters_.timeout);
  const std::int32_t frame = frame_of_setpoint(header.coord);
  check_frame(frame, "the neck and a person's head (13, 14)");
  if (!has_turn("setpoint", *sets_, header.src)) return;
  frames_.when_known(kRobot, frame, time, [this, time, frame, q](const auto& T_robot_frame) {
    const Eigen::Isometry3d T =
        T_robot_frame ? *T_robot_frame : frames_.nearest(kRobot, frame, time);
    controller_->targets.set(time, hc::gaze::angles_of(Eigen::Quaterniond(T.linear()) * q));
    follow();
  });
}

void Gaze::push(const hc::MessageOf<hc::TableKind<double>>& message) {
  const auto& header = message.header;
  const double left = message.numbers()[0], down = message.numbers()[1];
  time_of(header, hc::seconds(kLetGo));
  // A centred stick only ends a push of the same source.
  const bool is_let_go = left == 0 && down == 0;
  const auto* pushed_by = pushes_.holder(module_.monotonic());
  if (is_let_go && (pushed_by == nullptr || *pushed_by != header.src)) return;
  if (!has_turn("stick", pushes_, header.src)) return;
  if (is_let_go) pushes_.release(header.src);
  controller_->push(module_.now(), left, down, measured());
  // A push does not wait for the next periodic bid.
  if (!was_wanted_ && controller_->wants_head(module_.now())) send_bid();
  steer();
}

void Gaze::send(const std::optional<hc::gaze::Angles>& to) {
  if (to) command_.send({0.0, to->tilt, to->pan}, module_.now());
}

void Gaze::send_bid() {
  was_wanted_ = controller_->wants_head(module_.now());
  const double salience = was_wanted_ ? *parameters_.salience : *parameters_.idle_salience;
  bid_.send(salience, module_.now());
}

hc::gaze::Angles Gaze::measured() {
  return hc::gaze::angles_of(
      Eigen::Quaterniond(frames_.nearest(kRobot, kHead, module_.now()).linear()));
}

hc::Time Gaze::time_of(const hc::Header& header, double oldest) const {
  if (header.time <= hc::Time()) return module_.now();
  const double age = hc::seconds(module_.now() - header.time);
  if (age <= oldest && age >= -kAhead) return header.time;
  throw hc::BadMessage(
      hc::format("it is {:.3f} s {}", std::abs(age), age > 0 ? "old" : "in the future"));
}

void Gaze::check_frame(std::int32_t frame, const std::string& others) {
  if (const auto chain = frames_.tree().chain(kRobot, frame); !chain)
    throw hc::BadMessage(hc::format("coordinate system {} is not one of {}, and {}", frame, others,
                                    chain.error().detail));
}

bool Gaze::has_turn(const std::string& what, Sources& turn, std::int32_t source) {
  if (turn.take(source, module_.monotonic())) return true;
  module_.log_once(what + " of a second source",
                   hc::format("{} of source {} dropped: source {} is in control", what, source,
                              *turn.holder(module_.monotonic())));
  return false;
}
