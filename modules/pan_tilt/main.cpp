// SPDX-License-Identifier: Apache-2.0
// The robot's neck: turns the head by a pan-tilt unit on a serial line, and reports where it looks.
#include <algorithm>
#include <cmath>

#include <drivers/pan_tilt/neck.h>
#include <frames/messages.h>
#include <hc/base/format.h>
#include <hc/module/module.h>

namespace {

constexpr std::int32_t kRobotFromHead = hc::transform_coord(hc::Coord::kRobot, hc::Coord::kHead);
constexpr std::chrono::milliseconds kTick{10};  // how finely time-outs are kept

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"pan_tilt", "Turns the head by a FLIR pan-tilt unit; reports where it looks."};
  auto command =
      module.input("command", hc::rotation<double>().of(1, 1).in(hc::Coord::kGaze).finite(),
                   "roll (ignored), tilt, pan to take [rad]; the newest is used");
  auto device_input = module.input("device", hc::string(), "device to open; none when empty");
  auto gaze = module.output("gaze", hc::rotation<double>().of(1, 1).in(hc::Coord::kGaze),
                            "0, tilt, pan as measured [rad]");
  auto pose = module.output("pose", hc::transformation<double>().in(kRobotFromHead),
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
  module.actor(command);

  const hc::SystemClock clock;
  hc::pan_tilt::Neck neck([&](std::string_view line) { module.log(line); });
  std::string last_parameter;

  auto send_seen = [&] {
    const auto seen = neck.conversation().gaze();
    if (!seen) return;
    const std::int64_t time = module.now() - (clock.monotonic() - seen->time).count();
    gaze.send(hc::rotation(0.0, seen->tilt, seen->pan).at(time));
    const Eigen::Isometry3d T_robot_head(hc::frames::rotation(0, seen->tilt, seen->pan));
    if (pose.linked()) pose.send(hc::transformation(T_robot_head).at(time));
  };
  auto follow_parameters = [&] {
    neck.conversation().set_pace(*speed, *acceleration);
    neck.conversation().set_hold(hc::duration(*hold));
    // A device by message counts until the parameter changes.
    if (*device != last_parameter)
      neck.set_device(clock.monotonic(), last_parameter = *device, /*stays=*/true);
    neck.set_baud(clock.monotonic(), static_cast<int>(*baud));
  };

  module.on_start(follow_parameters);
  module.on(device_input, [&](const auto& message) {
    neck.set_device(clock.monotonic(), std::string(message.characters()), /*stays=*/false);
  });
  module.on(command, [&](const auto& message) {
    // It may have waited anywhere, for as long as this process was stopped.
    if (message.header.time == 0)
      return module.log_once("without a time", "command dropped: it has no time");
    const double old = module.seconds_since(message.header.time);
    if (std::abs(old) > *age)
      return module.log_once("stale", hc::format("command dropped: {:.3f} s {}", std::abs(old),
                                                 old > 0 ? "old" : "in the future"));
    const auto angles = message.numbers();
    if (!neck.command(clock.monotonic(), angles[2], angles[1],
                      hc::duration(*age - std::max(old, 0.0))))
      module.log_once("no unit", "command dropped: pan-tilt unit not connected");
  });
  module.on_readable([&] { return neck.descriptor(); },
                     [&] {
                       neck.read(clock.monotonic());
                       send_seen();
                     });
  module.every(rate, [&] { neck.look(clock.monotonic()); });
  module.every(kTick, [&] {
    follow_parameters();
    neck.pass(clock.monotonic());
    send_seen();
  });
  const int status = module.run(argc, argv);
  neck.leave();
  return status;
}
