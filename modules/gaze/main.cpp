// SPDX-License-Identifier: Apache-2.0
// Turns the head to where a task wants it to look, and bids for the head while it wants that.
#include <cmath>
#include <optional>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <gaze/stick.h>
#include <hc/module/module.h>
#include <vision/marker.h>

#include "controller.h"
#include "seen.h"

namespace {

/// How often a push is repeated: the first time may come before the head is granted.
constexpr std::chrono::milliseconds kSteer{5};

/// Targets further in the future, by another clock, are dropped [ns].
constexpr std::int64_t kAhead = 200'000'000;

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"gaze",
                    "Turns the head to a target, and bids for the head while there is one."};
  auto target =
      module.input("target",
                   hc::any_of(hc::position<double>(), hc::transformation<double>(4, 4),
                              hc::table<double>().of(hc::vision::kMarkerColumns, 0)),
                   "x, y in the left (7) or right (8) image [px], or a place in any frame [m]; a "
                   "pose of marker, or its table");
  auto setpoint =
      module.input("setpoint", hc::rotation<double>(), "setpoint: roll, tilt, pan [rad]");
  auto stick = module.input("stick", hc::table<double>().of(2, 1).finite(),
                            "turn to the left, turn down, -1 … 1 of stick_rate");
  auto calibration = module.input("calibration", hc::table<double>(), "result of calibrate");
  module.keep(target);
  module.keep(setpoint);
  module.keep(stick);
  module.keep(calibration);
  auto command = module.output("command", hc::rotation<double>().in(hc::Coord::kGaze),
                               "commanded head orientation: roll 0, tilt, pan [rad]");
  auto bid = module.output("bid", hc::table<double>(),
                           "salience while there is a target, else idle_salience");
  hc::ModuleFrames frames{module};
  const Parameters parameters{module};

  std::optional<Controller> controller;
  bool was_wanted = false;  // in the last bid
  bool was_ahead = false;   // the last target's time was in the future

  module.on_start([&] {
    controller.emplace(parameters, Targets(parameters.eyes(frames.fixed(kHead, kLeftEye),
                                                           frames.fixed(kHead, kRightEye)),
                                           parameters.follower(), *parameters.distance));
    const auto& file = *parameters.calibration_file;
    if (file.empty()) return;
    hc::succeed_or_end(
        controller->targets.calibrate(hc::value_or_end(hc::vision::read_calibration(file))));
  });

  auto measured = [&] {
    return hc::gaze::angles_of(
        Eigen::Quaterniond(frames.nearest(kRobot, kHead, module.now()).linear()));
  };
  auto send = [&](const std::optional<hc::gaze::Angles>& to) {
    if (to) command.send(hc::rotation(0.0, to->tilt, to->pan).at(module.now()));
  };
  auto follow = [&] { send(controller->follow(module.now(), measured())); };
  auto steer = [&] { send(controller->steer(module.now(), measured())); };
  auto send_bid = [&] {
    was_wanted = controller->wants_head(module.now());
    const double salience = was_wanted ? *parameters.salience : *parameters.idle_salience;
    bid.send(hc::table({salience}).at(module.now()));
  };
  /// The time of what was sensed; nothing of what is to come, since it would hold back all that is
  /// sensed until then.
  auto sensed_at = [&](std::int64_t time) -> std::optional<std::int64_t> {
    if (time <= 0) return module.now();
    const std::int64_t ahead = time - module.now();
    const bool is_ahead = ahead > kAhead;
    if (is_ahead && !was_ahead)
      module.log("target dropped: its time is " + std::to_string(ahead / 1'000'000) +
                 " ms in the future (further drops are not logged)");
    was_ahead = is_ahead;
    return is_ahead ? std::nullopt : std::optional(time);
  };

  module.on(calibration, [&](const auto& message) {
    auto found = hc::gaze::HeadCalibration::of(message.matrix().numbers());
    if (!found) return module.log("calibration: " + found.error().detail);
    controller->targets.calibrate(*found);
  });
  module.on(target, [&](const hc::Message& message) {
    const auto seen = seen_of(message);
    if (!seen) return;
    const auto time = sensed_at(message.header.time);
    if (!time) return;
    const std::int32_t frame = Targets::frame_of(seen->coord);
    if (auto chain = frames.tree().chain(kRobot, frame); !chain)
      throw hc::BadMessage("coordinate system " + std::to_string(seen->coord) +
                           " is no image of an eye (7, 8), and " + chain.error().detail);
    frames.when_known(kRobot, frame, *time, [&, time, frame, seen](const auto& T_robot_frame) {
      controller->targets.see(
          *time, seen->coord, seen->p,
          T_robot_frame ? *T_robot_frame : frames.nearest(kRobot, frame, *time));
      follow();
    });
  });
  module.on(setpoint, [&](const auto& message) {
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("setpoint: " + q.error().detail);
    const auto time = sensed_at(message.header.time);
    if (!time) return;
    controller->targets.set(*time, hc::gaze::angles_of(*q));
    follow();
  });
  module.on(stick, [&](const auto& message) {
    controller->push(module.now(), message.numbers()[0], message.numbers()[1], measured());
    // A person's push does not wait for the next bid.
    if (!was_wanted && controller->wants_head(module.now())) send_bid();
    steer();
  });

  module.every(parameters.rate, follow);
  module.every(kSteer, steer);
  module.every(std::chrono::milliseconds(100), send_bid);
  return module.run(argc, argv);
}
