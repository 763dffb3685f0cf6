// SPDX-License-Identifier: Apache-2.0
// The robot's neck: turns the head with a pan-tilt unit on a serial line; reports its orientation.
#include <drivers/pan_tilt/neck.h>
#include <frames/messages.h>
#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"pan_tilt", "Turns the head by a FLIR pan-tilt unit; reports where it looks."};
  auto command =
      module.input("command", hc::rotation().of(1, 1).in(hc::Coord::kGaze).finite(),
                   "roll (ignored), tilt, pan to take [rad]; the newest is used, of one source of "
                   "a mode at a time", {.actor = true, .keep = 1});
  auto device_input = module.input("device", hc::string(), "device to open; none when empty");
  auto gaze = module.output("gaze", hc::rotation().of(1, 1).in(hc::Coord::kGaze),
                            "0, tilt, pan as measured [rad]");
  auto pose = module.output(
      "pose",
      hc::transformation().in(hc::transform_coord(hc::Coord::kRobot, hc::Coord::kHead)),
      "T_robot_head at the same time");
  auto device =
      module.parameter("device", "", "", "serial device, e.g. /dev/ttyUSB0", {.positional = true});
  auto baud = module.parameter("baud", 9600, "1/s", "baud rate", {.min = 300, .max = 4e6});
  auto rate = module.parameter("rate", 50.0, "Hz", "how often the position is read",
                               {.min = 0, .max = 1000});
  auto age = module.parameter("age", 0.2, "s", "maximum age of a command; older ones are dropped",
                              {.min = 0.001, .max = 60});
  auto hold = module.parameter("hold", 0.15, "s",
                               "the unit is halted after this time without a command, 0: never",
                               {.min = 0, .max = 60});
  auto speed = module.parameter("speed", 0.0, "rad/s", "maximum of each axis, 0: the unit's own",
                                {.min = 0, .max = 100});
  auto acceleration = module.parameter("acceleration", 0.0, "rad/s2",
                                       "of each axis, 0: the unit's own", {.min = 0, .max = 1000});

  auto now = [] { return hc::SystemClock().monotonic(); };
  hc::pan_tilt::Neck neck(
      [&](hc::Level level, std::string_view line) { module.log(line, level); },
      [&](const auto&... problem) { module.log_once(problem...); },
      [&](const hc::pan_tilt::Gaze& seen) {
        const std::int64_t time = module.now() - (now() - seen.time).count();
        gaze.send({0.0, seen.tilt, seen.pan}, time);
        const Eigen::Isometry3d T_robot_head(hc::frames::rotation(0, seen.tilt, seen.pan));
        if (pose.linked()) pose.send(hc::numbers_of(T_robot_head), time);
      });
  auto pass = [&] {
    neck.set_focus(now(), module.focus());
    neck.pass(now(),
              {*device, static_cast<int>(*baud), *speed, *acceleration, hc::duration(*hold), *age});
  };

  module.on_start(pass);
  module.every(hc::pan_tilt::Neck::kTick, pass);
  module.every(rate, [&] { neck.look(now()); });
  module.on_readable([&] { return neck.descriptor(); },
                     [&] {
                       neck.set_focus(now(), module.focus());
                       neck.read(now());
                     });
  module.on(device_input, [&](const auto& name) { neck.set_device(now(), name.text()); });
  module.on(command, [&](const auto& message) {
    neck.set_focus(now(), module.focus());
    const auto angles = message.numbers();
    neck.command(
        now(), module.now(),
        {angles[2], angles[1], message.header.time, message.header.mode, message.header.src});
  });
  return module.run(argc, argv);
}
