// SPDX-License-Identifier: Apache-2.0
#pragma once
// Simulates a pan-tilt unit: the part of a PTU-D46 that is needed to turn a head. Pure: bytes in,
// bytes out, at times that come from the caller. Source: PTU-D46 Command Reference, version 2.14.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <drivers/pan_tilt/motion.h>

namespace hc::pan_tilt {

inline constexpr double kArcsecondsPerPosition = 185.1428;  ///< of both axes

/// Implements PP TP PO TO PS TS PD TD PA TA PB TB PU TU PL TL PR TR PN TN PX TX, I A H HP HT C CI
/// CV L LE LD E EE ED F FT FV R V O, with and without a value where they have one, in any case.
/// Starts as after power-on: echo, verbose, limits. Unlike a real unit, R moves to 0, 0 at the
/// current pace without searching for the limits first.
///
/// Positions are the unit's: pan > 0 left, tilt > 0 up. Times [s] must not decrease.
class Unit {
 public:
  /// @param pan, tilt  initial position, clamped to the limits [position].
  explicit Unit(double pan = 0, double tilt = 0);

  /// Takes bytes; returns the answers up to an `A` or `R`, which delays the rest, up to 256 bytes.
  /// A word that does not fit is lost as a whole.
  std::string take(double time, std::string_view bytes);
  /// Returns delayed output up to a time: the end of an awaited motion, or of one at a limit.
  std::string pass(double time);
  /// When pass() has output next, if no bytes arrive before.
  [[nodiscard]] std::optional<double> next() const;

  /// Current position [position].
  [[nodiscard]] double pan(double time) const { return axes_[0].motion.at(time).position; }
  [[nodiscard]] double tilt(double time) const { return axes_[1].motion.at(time).position; }

 private:
  struct Axis {
    const char* name;  // "Pan"
    char letter;       // 'P'
    int least, most;   // [position]
    Motion motion;
    int speed = 1000;              // commanded; signed in velocity control
    int upper = 2902, lower = 31;  // [position/s]
    bool runs_into_limit = false;  // reported when the motion ends
  };
  enum class Busy { No, Awaits, Resets };

  void obey(double time);
  std::string answer(double time, std::string_view words);
  std::string set(double time, Axis& axis, char property, int value);
  std::string ask(double time, const Axis& axis, char property) const;
  std::string of_unit(double time, std::string_view words);
  std::string go(double time, Axis& axis, int position);
  std::string set_speed(double time, Axis& axis, int speed);
  [[nodiscard]] std::string result(std::string_view verbose, std::string_view value,
                                   std::string_view unit = "") const;
  [[nodiscard]] double still() const;

  std::array<Axis, 2> axes_;
  std::string waiting_;  // not yet executed
  bool skips_ = false;   // skipping a word that did not fit
  std::string said_;
  Busy busy_ = Busy::No;
  bool echoes_ = true, verbose_ = true, limits_ = true, controls_speed_ = false;
};

}  // namespace hc::pan_tilt
