// SPDX-License-Identifier: Apache-2.0
// Turns the head to a target, setpoint or stick, and bids for the head while there is one.
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <gaze/stick.h>
#include <hc/base/format.h>
#include <hc/base/turn.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/marker.h>

#include "controller.h"
#include "seen.h"

namespace {

/// Period of commands while a stick is pushed; the first may precede the focus.
constexpr std::chrono::milliseconds kSteer{5};

/// Messages further in the future, from a skewed clock, are dropped [s].
constexpr double kAhead = 0.2;

/// A pushed stick is repeated; after this silence it counts as released.
constexpr std::chrono::milliseconds kLetGo{250};

/// Frame of a setpoint: the robot's for angles of the neck (13) or a person's head (14), or if 0.
std::int32_t frame_of_setpoint(std::int32_t coord) {
  const bool is_of_neck =
      coord == 0 || coord == hc::Coord::kGaze || coord == hc::Coord::kSupervisor;
  return is_of_neck ? kRobot : coord;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"gaze",
                    "Turns the head to a target, and bids for the head while there is one."};
  auto target = module.input(
      "target",
      hc::any_of(hc::position(), hc::transformation(),
                 hc::table().of(0, hc::vision::kMarkerColumns)),
      "x, y in the left (7) or right (8) image [px], or a position in any frame [m]; a "
      "pose of marker, or its table; in each image or frame of one source at a time", {.keep = 1});
  auto setpoint = module.input(
      "setpoint", hc::rotation(),
      "orientation to take, roll, tilt, pan [rad]: of the neck (13) or a person's head "
      "(14), or in a frame; of one source at a time", {.keep = 1});
  auto stick = module.input("stick", hc::table().of(1, 2).finite(),
                            "turn to the left, turn down, -1 … 1 of stick_rate; repeated while "
                            "pushed; of one source at a time", {.keep = 1});
  auto calibration = module.input("calibration", hc::table(), "result of calibrate", {.keep = 1});
  auto command = module.output("command", hc::rotation().in(hc::Coord::kGaze),
                               "commanded head orientation: roll 0, tilt, pan [rad]");
  auto bid = module.output("bid", hc::table(),
                           "salience while there is a target, else idle_salience");
  hc::ModuleFrames frames{module};
  const GazeParameters parameters{module};

  std::optional<Controller> controller;
  bool was_wanted = false;  // in the last bid
  hc::Turn<std::int32_t> pushes{kLetGo};
  std::optional<hc::Turn<std::int32_t>> sets;             // a setpoint
  std::map<std::int32_t, hc::Turn<std::int32_t>> sights;  // the target, by coordinate system

  module.on_start([&] {
    sets.emplace(hc::duration(*parameters.timeout));
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
    if (to) command.send({0.0, to->tilt, to->pan}, module.now());
  };
  auto follow = [&] { send(controller->follow(module.now(), measured())); };
  auto steer = [&] { send(controller->steer(module.now(), measured())); };
  auto send_bid = [&] {
    was_wanted = controller->wants_head(module.now());
    const double salience = was_wanted ? *parameters.salience : *parameters.idle_salience;
    bid.send({salience}, module.now());
  };
  /// Time of a message. Drops old ones, and ones from the future, which would block all until then.
  auto time_of = [&](const hc::Header& header, double oldest) -> std::int64_t {
    if (header.time <= 0) return module.now();
    const double age = hc::seconds(module.now() - header.time);
    if (age <= oldest && age >= -kAhead) return header.time;
    throw hc::BadMessage(
        hc::format("it is {:.3f} s {}", std::abs(age), age > 0 ? "old" : "in the future"));
  };
  /// Drops a message whose frame has no transform to the robot's.
  auto check_frame = [&](std::int32_t frame, const std::string& others) {
    if (const auto chain = frames.tree().chain(kRobot, frame); !chain)
      throw hc::BadMessage(hc::format("coordinate system {} is not one of {}, and {}", frame,
                                      others, chain.error().detail));
  };
  /// Whether a source is in control, of several that send to one input.
  auto has_turn = [&](const std::string& what, hc::Turn<std::int32_t>& turn, std::int32_t source) {
    if (turn.take(source, module.monotonic())) return true;
    module.log_once(what + " of a second source",
                    hc::format("{} of source {} dropped: source {} is in control", what, source,
                               *turn.holder(module.monotonic())));
    return false;
  };

  module.on(calibration, [&](const auto& message) {
    auto found = hc::gaze::HeadCalibration::of(message.matrix().numbers());
    if (!found) return module.log("calibration: " + found.error().detail);
    controller->targets.calibrate(*found);
  });
  module.on(target, [&](const hc::Message& message) {
    const auto seen = seen_of(message);
    if (!seen) return;
    const auto time = time_of(message.header, *parameters.timeout);
    const std::int32_t frame = Targets::frame_of(seen->coord);
    check_frame(frame, "an eye and its image (4, 5, 7, 8)");
    // The eyes share one target, but two sources with the same eye see different ones.
    auto& turn = sights.try_emplace(seen->coord, hc::duration(*parameters.timeout)).first->second;
    if (!has_turn("target", turn, message.header.src)) return;
    frames.when_known(kRobot, frame, time, [&, time, frame, seen](const auto& T_robot_frame) {
      controller->targets.see(time, seen->coord, seen->p,
                              T_robot_frame ? *T_robot_frame : frames.nearest(kRobot, frame, time));
      follow();
    });
  });
  module.on(setpoint, [&](const auto& message) {
    const auto& header = message.header;
    const auto q = hc::value_or_drop(hc::rotation_of(message));
    const auto time = time_of(header, *parameters.timeout);
    const std::int32_t frame = frame_of_setpoint(header.coord);
    check_frame(frame, "the neck and a person's head (13, 14)");
    if (!has_turn("setpoint", *sets, header.src)) return;
    frames.when_known(kRobot, frame, time, [&, time, frame, q](const auto& T_robot_frame) {
      const Eigen::Isometry3d T =
          T_robot_frame ? *T_robot_frame : frames.nearest(kRobot, frame, time);
      controller->targets.set(time, hc::gaze::angles_of(Eigen::Quaterniond(T.linear()) * q));
      follow();
    });
  });
  module.on(stick, [&](const auto& message) {
    const auto& header = message.header;
    const double left = message.numbers()[0], down = message.numbers()[1];
    time_of(header, hc::seconds(kLetGo));
    // A centred stick only ends a push of the same source.
    const bool is_let_go = left == 0 && down == 0;
    const auto* pushed_by = pushes.holder(module.monotonic());
    if (is_let_go && (pushed_by == nullptr || *pushed_by != header.src)) return;
    if (!has_turn("stick", pushes, header.src)) return;
    if (is_let_go) pushes.release(header.src);
    controller->push(module.now(), left, down, measured());
    // A push does not wait for the next periodic bid.
    if (!was_wanted && controller->wants_head(module.now())) send_bid();
    steer();
  });

  module.every(parameters.rate, follow);
  module.every(kSteer, steer);
  module.every(std::chrono::milliseconds(100), send_bid);
  return module.run(argc, argv);
}
