// SPDX-License-Identifier: Apache-2.0
// A person's wish to turn the head, by a game controller.
#include <drivers/joystick/joystick.h>
#include <drivers/joystick/stick.h>

#include <algorithm>

#include <hc/base/clock.h>
#include <hc/module/module.h>
#include <hc/os/program.h>

namespace {

constexpr std::chrono::milliseconds kLook{20};  // how long commands may go unnoticed
constexpr double kLeastRate = 1e-3;             // one that is lower counts as this [Hz]

template <typename Output, typename T>
void send(Output& output, const std::vector<T>& numbers, std::int64_t time) {
  auto draft = output.loan(static_cast<std::int32_t>(numbers.size()), 1);
  draft.header.time = time;
  std::copy(numbers.begin(), numbers.end(), draft.matrix().numbers().begin());
  output.send(std::move(draft));
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"joystick", "Gives a game controller's sticks and buttons."};
  auto stick = module.output("stick", hc::table<double>(),
                             "1 x 2: left > 0, down > 0, each -1 to 1, of the left stick");
  auto axes = module.output("axes", hc::table<double>(),
                            "as they are, -1 to 1: left x, y, right x, y, left and right trigger");
  auto buttons = module.output("buttons", hc::table<std::uint8_t>(),
                               "1 where one is pressed: A, B, X, Y, back, guide, start, left and "
                               "right stick, left and right shoulder, up, down, left, right, …");
  auto dead_zone = module.parameter("dead_zone", 0.1, "",
                                    "of the stick, what is nearer to the middle counts as 0",
                                    {.min = 0, .max = 0.9});
  auto rate = module.parameter("rate", 50.0, "Hz",
                               "how often the stick is told while it is out of its middle",
                               {.min = 0, .max = 1000});

  const hc::SystemClock clock;
  std::unique_ptr<hc::Joystick> joystick;
  hc::JoystickState told;
  hc::StickTeller teller;

  module.on_start([&] {
    joystick = hc::value_or_end(hc::Joystick::open());
    if (joystick->state().name.empty()) module.log("no joystick, waits for one");
  });
  auto tell_name = [&](const std::string& name) {
    if (name == told.name) return;
    module.log(name.empty() ? told.name + " has gone" : name + " is there");
  };
  module.generate([&] {
    const auto period = std::chrono::duration_cast<hc::MonotonicTime>(
        std::chrono::duration<double>(1 / std::max(*rate, kLeastRate)));
    auto rest = std::chrono::milliseconds(kLook);
    if (auto due = teller.rest(clock.monotonic(), period))
      rest = std::min(rest, std::chrono::ceil<std::chrono::milliseconds>(*due));
    joystick->wait(rest, hc::stop_descriptor());
    const auto& state = joystick->state();
    const auto time = module.now();
    tell_name(state.name);
    // The stick first: somebody moves by it.
    const auto wish = hc::stick_of(state.axes, *dead_zone);
    if (teller.is_due(clock.monotonic(), wish, period))
      send(stick, std::vector<double>{wish.left, wish.down}, time);
    if (state.axes != told.axes) send(axes, state.axes, time);
    if (state.buttons != told.buttons) send(buttons, state.buttons, time);
    told = state;
    return true;
  });
  return module.run(argc, argv);
}
