// SPDX-License-Identifier: Apache-2.0
#pragma once
// The game controller that is plugged in, by SDL2; another joystick where it has no mapping. None
// is no error: it may be plugged in later, and again. One in the process, for one thread.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// State of axes and buttons. A controller's axes are, in this order, left stick x, y, right stick
/// x, y (right and down > 0), left and right trigger (0 … 1); its buttons those of
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

  /// Takes events up to the next change of the state; false when there is none. Each press and
  /// release of a button is a change of its own, however close they are. Never waits.
  bool update();

  /// The joystick's device file, readable when there may be events; -1 where there is none.
  [[nodiscard]] int descriptor() const;
  /// How long update() may be put off besides: SDL gives no descriptor. 20 ms with a device file,
  /// 1 ms without one, 100 ms to find a new joystick.
  [[nodiscard]] std::chrono::milliseconds pace() const;

  /// The name of a joystick that another process of this library has, so that it is not used here;
  /// looked for again each second. Empty: there is none, or this process has one.
  [[nodiscard]] const std::string& taken() const { return taken_; }

  /// All axes and buttons are 0 once it is unplugged.
  [[nodiscard]] const JoystickState& state() const { return state_; }

 private:
  struct Device;
  Joystick();
  bool attach_any();
  void detach();

  std::unique_ptr<Device> device_;  ///< null: none
  JoystickState state_;
  std::string taken_;
  std::uint32_t look_again_ = 0;  ///< by SDL's clock [ms]
};

}  // namespace hc
