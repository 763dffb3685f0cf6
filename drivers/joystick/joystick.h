// SPDX-License-Identifier: Apache-2.0
#pragma once
// The game controller that is plugged in, by SDL2; another joystick where it has no mapping. None
// is no error: it may come, go and come back. One in the process, for one thread.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// What is held how. A controller's axes are, in this order, left stick x, y, right stick x, y
/// (right and down > 0), left and right trigger (0 … 1); its buttons those of
/// SDL_GameControllerButton: A, B, X, Y, back, guide, start, left and right stick, left and right
/// shoulder, up, down, left, right, … Another joystick's are in its own order.
struct JoystickState {
  std::string name;                   ///< empty: there is none
  std::vector<double> axes;           ///< each −1 … 1; as many as the last joystick had
  std::vector<std::uint8_t> buttons;  ///< 1: pressed
  bool operator==(const JoystickState&) const = default;
};

class Joystick {
 public:
  /// Errors: System (SDL does not start).
  static Result<std::unique_ptr<Joystick>> open();
  Joystick(const Joystick&) = delete;
  Joystick& operator=(const Joystick&) = delete;
  ~Joystick();

  /// Waits until the state has changed; false when `timeout` has passed or `stop` is readable. Each
  /// press and release of a button is a change of its own, however close they are.
  ///
  /// SDL gives no descriptor. Where the joystick is a device file, this waits for that file, and
  /// looks every 20 ms besides; else it looks every millisecond, and for new ones every 100 ms.
  bool wait(std::chrono::milliseconds timeout, int stop = -1);

  /// All axes and buttons are 0 once it has gone.
  [[nodiscard]] const JoystickState& state() const { return state_; }

 private:
  struct Device;
  Joystick();
  bool take_events();
  bool attach_any();
  void detach();
  [[nodiscard]] std::chrono::milliseconds pace() const;

  std::unique_ptr<Device> device_;  ///< null: none
  JoystickState state_;
};

}  // namespace hc
