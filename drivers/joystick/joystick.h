// SPDX-License-Identifier: Apache-2.0
#pragma once
// The connected game controller, or a joystick without a mapping, with SDL2. May be connected and
// disconnected at any time. One per process, for one thread.

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// State of axes and buttons. A controller's axes are left stick x, y, right stick x, y (right and
/// down > 0), left and right trigger (0 … 1); its buttons are those of SDL_GameControllerButton: A,
/// B, X, Y, back, guide, start, left and right stick, left and right shoulder, up, down, left,
/// right, … A joystick without a mapping has its own order; its hats, which D-pads are, are two
/// more axes each, x and y.
struct JoystickState {
  std::string name;                   ///< empty: none connected
  std::vector<double> axes;           ///< each −1 … 1; those of the last joystick
  std::vector<std::uint8_t> buttons;  ///< 1: pressed
  bool operator==(const JoystickState&) const = default;
};

class Joystick {
 public:
  /// Errors: System (SDL cannot start).
  static Result<std::unique_ptr<Joystick>> open();
  Joystick(const Joystick&) = delete;
  Joystick& operator=(const Joystick&) = delete;
  ~Joystick();

  /// Takes events up to the next change of the state; false if there is none. Each press and
  /// release of a button is a separate change, however close. Never blocks.
  bool update();

  /// The joystick's device file, readable when there may be events; -1 if there is none.
  [[nodiscard]] int descriptor() const;
  /// Maximum time between calls of update(), since SDL has no descriptor: 20 ms with a device file,
  /// 1 ms without, 100 ms to find a new joystick.
  [[nodiscard]] std::chrono::milliseconds pace() const;

  /// The name of a joystick in use by another process of this library, retried each second. Empty
  /// if there is none, or this process has one.
  [[nodiscard]] const std::string& taken() const { return taken_; }

  /// All axes and buttons are 0 after it is unplugged.
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
