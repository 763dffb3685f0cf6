// SPDX-License-Identifier: Apache-2.0
// Reads a game controller, with which a person turns the head.
#include <string>
#include <utility>

#include <drivers/joystick/changes.h>
#include <drivers/joystick/joystick.h>

#include <hc/module/module.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"joystick", "Sends a game controller's sticks and buttons."};
  auto stick = module.output("stick", hc::table().of(1, 2),
                             "left > 0, down > 0, each -1 to 1, of the left stick",
                             {.columns = {"left", "down"}});
  auto axes =
      module.output("axes", hc::table(),
                    "raw, -1 to 1: left x, y, right x, y, left and right trigger; without a "
                    "mapping its own, then x, y of each hat");
  auto buttons = module.output("buttons", hc::table<std::uint8_t>(),
                               "1 if pressed: A, B, X, Y, back, guide, start, left and "
                               "right stick, left and right shoulder, up, down, left, right, …");
  auto dead_zone = module.parameter("dead_zone", 0.1, "", "of the stick: smaller deflections are 0",
                                    {.min = 0, .max = 0.9});
  auto rate = module.parameter("rate", 50.0, "Hz",
                               "repetition rate while the stick is deflected; a silent "
                               "stick counts as released",
                               {.min = 20, .max = 1000});

  std::unique_ptr<hc::Joystick> joystick;
  hc::JoystickWatch watch;

  auto send_stick = [&] { stick.send({watch.stick().left, watch.stick().down}, module.now()); };
  auto send_changes = [&] {
    const auto& state = joystick->state();
    const auto time = module.now();
    const auto changes = watch.take(state, *dead_zone);
    if (!changes.line.empty()) module.log(changes.line, changes.level);
    // The stick first: the head moves by it.
    if (changes.stick) send_stick();
    if (changes.axes) axes.send(state.axes, time);
    if (changes.buttons) buttons.send(state.buttons, time);
  };
  std::string taken;
  auto update = [&] {
    while (joystick->update()) send_changes();
    if (std::exchange(taken, joystick->taken()) != taken && !taken.empty())
      module.log(taken + " is used by another graph; waiting for it", hc::Level::Warning);
  };
  hc::Timeout look = module.after(std::chrono::nanoseconds(0), [&] {
    update();
    look.restart(joystick->pace());
  });

  module.on_start([&] {
    joystick = hc::value_or_end(hc::Joystick::open());
    update();
    if (joystick->state().name.empty() && taken.empty())
      module.log("no joystick found; waiting", hc::Level::Warning);
    send_changes();
  });
  module.on_readable([&] { return joystick->descriptor(); }, update);
  module.every(rate, [&] {
    if (!watch.stick().is_in_middle()) send_stick();
  });
  return module.run(argc, argv);
}
