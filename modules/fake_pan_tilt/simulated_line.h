// SPDX-License-Identifier: Apache-2.0
#pragma once
// A serial line with a simulated pan-tilt unit at one end, and a pseudo-terminal at the other.
// Never waits; the same seed, the same damage.

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
  static constexpr double kLook = 0.02;  ///< how often serve() is to be called at least [s]

  /// Unplugged. @param pan, tilt  where the unit is, to the left and down [rad].
  SimulatedLine(double pan, double tilt, std::uint64_t seed);

  /// Plugs in a new line, or unplugs it, and what is on its way is lost; gives whether that changed
  /// anything.
  ///
  /// Errors: System (Terminal::open()).
  hc::Result<bool> plug(bool in);
  /// What others open; "" while unplugged.
  [[nodiscard]] std::string path() const { return terminal_ ? terminal_->path() : ""; }
  /// For poll(); -1 while unplugged.
  [[nodiscard]] int descriptor() const { return terminal_ ? terminal_->descriptor() : -1; }

  /// Does all that is due: bytes reach the unit, and its answers the terminal. Gives those bytes.
  /// @param time  does not fall [s].
  /// @param faults  of the way back; the way to the unit is as slow, but neither late nor bad.
  /// @param is_silent  the unit obeys, but does not answer.
  std::string serve(double time, const Wire::Faults& faults, bool is_silent);
  /// How long until there is something due again, at most kLook [s].
  [[nodiscard]] double pause(double time) const;

  /// Where the unit is [rad].
  [[nodiscard]] double pan(double time) const { return unit_.pan(time) * kStep; }
  [[nodiscard]] double tilt(double time) const { return -unit_.tilt(time) * kStep; }

 private:
  static constexpr double kStep =
      hc::pan_tilt::kArcsecondsPerPosition / 3600 * std::numbers::pi / 180;  // [rad/position]

  hc::pan_tilt::Unit unit_;
  std::optional<Terminal> terminal_;
  Wire to_unit_, from_unit_;
};
