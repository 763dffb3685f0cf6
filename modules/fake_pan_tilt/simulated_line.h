// SPDX-License-Identifier: Apache-2.0
#pragma once
// A serial line with a simulated pan-tilt unit at one end and a pseudo-terminal at the other. Never
// blocks. The same seed gives the same corruption.

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

#include <drivers/pan_tilt/unit.h>
#include <hc/base/result.h>

#include "terminal.h"
#include "wire.h"

class SimulatedLine {
 public:
  static constexpr double kLook = 0.02;  ///< maximum time between calls of serve() [s]

  /// Starts unplugged. @param pan, tilt  position of the unit, > 0 left and down [rad].
  SimulatedLine(double pan, double tilt, std::uint64_t seed);

  /// Plugs in a new line, or unplugs it, which loses the bytes on it. Returns whether this changed
  /// anything. Errors: System (Terminal::open()).
  hc::Result<bool> plug(bool in);
  /// The device to open; "" while unplugged.
  [[nodiscard]] std::string path() const { return terminal_ ? terminal_->path() : ""; }
  /// For poll(); -1 while unplugged.
  [[nodiscard]] int descriptor() const { return terminal_ ? terminal_->descriptor() : -1; }

  /// Passes bytes to the unit and its answers to the terminal as due. Returns the unit's bytes.
  /// @param time  must not decrease [s].
  /// @param faults  of the answers; bytes to the unit are only as slow.
  /// @param is_silent  the unit obeys, but does not answer.
  std::string serve(double time, const Wire::Faults& faults, bool is_silent);
  /// Time until the next byte or answer is due, at most kLook [s].
  [[nodiscard]] double pause(double time) const;

  /// Position of the unit [rad].
  [[nodiscard]] double pan(double time) const { return unit_.pan(time) * kStep; }
  [[nodiscard]] double tilt(double time) const { return -unit_.tilt(time) * kStep; }

 private:
  static constexpr double kStep =
      hc::pan_tilt::kArcsecondsPerPosition / 3600 * std::numbers::pi / 180;  // [rad/position]

  /// When a byte reaches the unit, or the unit says something.
  [[nodiscard]] std::optional<double> unit_due() const;

  hc::pan_tilt::Unit unit_;
  std::optional<Terminal> terminal_;
  Wire to_unit_, from_unit_;
  double served_ = 0;  // until when the unit has acted
};
