// SPDX-License-Identifier: Apache-2.0
#pragma once
// The robot's neck: turns the head with a pan-tilt unit on a serial line; reports its orientation.

#include <cstdint>
#include <string>
#include <string_view>

#include <drivers/pan_tilt/neck.h>
#include <frames/messages.h>
#include <hc/module/module.h>

struct PanTiltParameters {
  hc::Module& module;

  hc::Parameter<std::string> device =
      module.parameter("device", "", "", "serial device, e.g. /dev/ttyUSB0", {.positional = true});
  hc::Parameter<std::int64_t> baud =
      module.parameter("baud", 9600, "1/s", "baud rate", {.min = 300, .max = 4e6});
  hc::Parameter<double> rate = module.parameter(
      "rate", 50.0, "Hz", "how often the position is read", {.min = 0, .max = 1000});
  hc::Parameter<double> age =
      module.parameter("age", 0.2, "s", "maximum age of a command; older ones are dropped",
                       {.min = 0.001, .max = 60});
  hc::Parameter<double> hold = module.parameter(
      "hold", 0.15, "s", "the unit is halted after this time without a command, 0: never",
      {.min = 0, .max = 60});
  hc::Parameter<double> speed = module.parameter(
      "speed", 0.0, "rad/s", "maximum of each axis, 0: the unit's own", {.min = 0, .max = 100});
  hc::Parameter<double> acceleration = module.parameter(
      "acceleration", 0.0, "rad/s2", "of each axis, 0: the unit's own", {.min = 0, .max = 1000});

  [[nodiscard]] hc::pan_tilt::NeckSettings settings() const {
    return {*device, static_cast<int>(*baud), *speed, *acceleration, hc::duration(*hold), *age};
  }
};

class PanTilt {
 public:
  /// @param module  must outlive it.
  explicit PanTilt(hc::Module& module);

 private:
  void pass();
  void read();
  void turn(const hc::MessageOf<hc::RotationKind<double>>& message);
  void send(const hc::pan_tilt::Gaze& seen);

  hc::Module& module_;
  const hc::SystemClock clock_;
  hc::Input<hc::RotationKind<double>> command_ =
      module_.input("command", hc::rotation().of(1, 1).in(hc::Coord::kGaze).finite(),
                    "roll (ignored), tilt, pan to take [rad]; the newest is used, of one source of "
                    "a mode at a time",
                    {.actor = true, .keep = 1});
  hc::Input<hc::StringKind> device_input_ =
      module_.input("device", hc::string(), "device to open; none when empty");
  hc::Output<hc::RotationKind<double>> gaze_ = module_.output(
      "gaze", hc::rotation().of(1, 1).in(hc::Coord::kGaze), "0, tilt, pan as measured [rad]");
  hc::Output<hc::TransformationKind<double>> pose_ = module_.output(
      "pose", hc::transformation().in(hc::transform_coord(hc::Coord::kRobot, hc::Coord::kHead)),
      "T_robot_head at the same time");
  const PanTiltParameters parameters_{module_};
  hc::pan_tilt::Neck neck_{
      clock_, [this](hc::Level level, std::string_view line) { module_.log(line, level); },
      [this](const auto&... problem) { module_.log_once(problem...); },
      [this](const hc::pan_tilt::Gaze& seen) { send(seen); }};
};
