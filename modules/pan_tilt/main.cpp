// SPDX-License-Identifier: Apache-2.0
// The robot's neck: a pan-tilt unit at a serial line turns the head, and tells where it looks.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <drivers/pan_tilt/neck.h>
#include <hc/module/module.h>

namespace {

constexpr std::int32_t kGaze = 13, kRobotFromHead = 2003;
constexpr std::chrono::milliseconds kTick{10};  // how finely time-outs are kept

/// Commands that are not carried out; the first of a kind is told.
class LeftOut {
 public:
  explicit LeftOut(hc::Module& module) : module_(module) {}
  void add(std::int64_t& count, const std::string& why) {
    if (count++ == 0) module_.log("command: left out, as others may be: " + why);
  }
  void tell() const {
    if (late + untimed + wrong + unready == 0) return;
    module_.log("command: left out: " + std::to_string(late) + " of another time, " +
                std::to_string(untimed) + " without a time, " + std::to_string(unready) +
                " while there was no unit, " + std::to_string(wrong) + " without numbers");
  }
  std::int64_t late = 0, untimed = 0, wrong = 0, unready = 0;

 private:
  hc::Module& module_;
};

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"pan_tilt",
                    "Turns the head by a FLIR pan-tilt unit, and tells where it looks."};
  auto command = module.input("command", hc::rotation<double>().in(kGaze),
                              "roll (not used), tilt, pan to look at [rad]; the newest counts");
  auto told_device = module.input("device", hc::string(), "what to open; none when empty");
  auto gaze = module.output("gaze", hc::rotation<double>().in(kGaze),
                            "0, tilt, pan as the unit tells [rad]");
  auto pose = module.output("pose", hc::transformation<double>(4, 4).in(kRobotFromHead),
                            "T_robot_head at the same time");
  auto device = module.parameter("device", "", "", "serial line of the unit, as /dev/ttyUSB0",
                                 {.positional = true});
  auto baud = module.parameter("baud", 9600, "", "its rate", {.min = 300, .max = 4e6});
  auto rate = module.parameter("rate", 50.0, "Hz", "how often the unit is asked where it looks",
                               {.min = 0, .max = 1000});
  auto age = module.parameter("age", 0.2, "s",
                              "a command that is older, newer, or without a time, is left out",
                              {.min = 0.001, .max = 60});
  auto hold = module.parameter("hold", 0.2, "s",
                               "without a command for so long the unit is halted, 0: never",
                               {.min = 0, .max = 60});
  auto speed = module.parameter("speed", 0.0, "rad/s", "greatest of each axis, 0: the unit's own",
                                {.min = 0, .max = 100});
  auto acceleration =
      module.parameter("acceleration", 0.0, "rad/s2", "the same", {.min = 0, .max = 1000});
  module.actor(command);

  const hc::SystemClock clock;
  hc::pan_tilt::Neck neck([&](std::string_view line) { module.log(line); });
  LeftOut left_out(module);
  struct {
    std::string device;
    bool is_told = false;  // by a message, and not by the parameter
  } opened;
  std::string last_parameter;

  auto send = [&](const hc::pan_tilt::Gaze& seen) {
    const std::int64_t time = module.now() - (clock.monotonic() - seen.time).count();
    auto angles = gaze.loan(1, 1);
    angles.header.time = time;
    const double row[] = {0, seen.tilt, seen.pan};
    std::copy(std::begin(row), std::end(row), angles.matrix().numbers().begin());
    gaze.send(std::move(angles));
    if (!pose.linked()) return;
    auto matrix = pose.loan(4, 4);
    matrix.header.time = time;
    const double cp = std::cos(seen.pan), sp = std::sin(seen.pan);
    const double ct = std::cos(seen.tilt), st = std::sin(seen.tilt);
    // Rz(pan) Ry(tilt)
    const double rows[] = {cp * ct, -sp, cp * st, 0, sp * ct, cp, sp * st, 0,
                           -st,     0,   ct,      0, 0,       0,  0,       1};
    std::copy(std::begin(rows), std::end(rows), matrix.matrix().numbers().begin());
    pose.send(std::move(matrix));
  };
  auto open = [&] {
    neck.set_device(clock.monotonic(), opened.device, static_cast<int>(*baud), !opened.is_told);
  };
  /// What may have changed at any time.
  auto follow_parameters = [&] {
    auto& conversation = neck.conversation();
    conversation.set_pace(*speed, *acceleration);
    conversation.set_hold(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(*hold)));
    if (*device != last_parameter) opened = {last_parameter = *device, false};
    if (!opened.is_told) open();
  };

  module.on_start(follow_parameters);
  module.on(told_device, [&](const auto& message) {
    opened = {std::string(message.characters()), true};
    open();
  });
  module.on(command, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    if (message.header.width != 1 || message.header.height != 1 || !std::isfinite(numbers[1]) ||
        !std::isfinite(numbers[2]))
      return left_out.add(left_out.wrong, "it is not one gaze of finite angles");
    // It may have waited anywhere, for as long as this process was stopped.
    if (message.header.time == 0)
      return left_out.add(left_out.untimed, "it does not say when it was made (time 0)");
    const double seconds = static_cast<double>(module.now() - message.header.time) * 1e-9;
    if (std::abs(seconds) > *age)
      return left_out.add(left_out.late, std::to_string(std::abs(seconds)) + " s " +
                                             (seconds > 0 ? "old" : "in the future"));
    const std::chrono::duration<double> life(*age - std::max(seconds, 0.0));
    if (!neck.command(clock.monotonic(), numbers[2], numbers[1],
                      std::chrono::duration_cast<std::chrono::nanoseconds>(life)))
      left_out.add(left_out.unready, "there is no unit yet");
  });
  auto send_seen = [&] {
    if (auto seen = neck.conversation().gaze()) send(*seen);
  };
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
  left_out.tell();
  return status;
}
