// SPDX-License-Identifier: Apache-2.0
#pragma once
// Detects changes of a joystick's state that are worth a message. Pure.

#include <string>
#include <utility>

#include <drivers/joystick/joystick.h>
#include <drivers/joystick/stick.h>
#include <hc/base/log.h>

namespace hc {

struct JoystickChanges {
  std::string line;  ///< to log: which joystick was connected or disconnected; empty: neither
  Level level = Level::Info;  ///< of the line
  bool stick = false, axes = false, buttons = false;
};

class JoystickWatch {
 public:
  /// The changes since the last state.
  /// @param dead_zone  as in stick_of().
  JoystickChanges take(const JoystickState& state, double dead_zone) {
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
  /// The stick in the last state.
  [[nodiscard]] const Stick& stick() const { return stick_; }

 private:
  JoystickState state_;
  Stick stick_;
};

}  // namespace hc
