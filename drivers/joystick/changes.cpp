// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/changes.h>

#include <utility>

namespace hc {

JoystickChanges JoystickWatch::take(const JoystickState& state, double dead_zone) {
  const JoystickState last = std::exchange(state_, state);
  const Stick last_stick = std::exchange(stick_, stick_of(state.axes, dead_zone));
  JoystickChanges changes;
  if (state.name != last.name) {
    const bool is_lost = state.name.empty();
    changes.level = is_lost ? Level::Warning : Level::Info;
    changes.line = is_lost ? last.name + " disconnected" : state.name + " connected";
  }
  changes.stick = stick_ != last_stick;
  changes.axes = state.axes != last.axes;
  changes.buttons = state.buttons != last.buttons;
  return changes;
}

}  // namespace hc
