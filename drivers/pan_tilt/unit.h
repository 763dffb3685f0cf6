// SPDX-License-Identifier: Apache-2.0
#pragma once
// A pan-tilt unit that is simulated: a PTU-D46 as its manual describes it, as far as a client that
// turns a head is asked for. Bytes in, bytes out, at a time that is given. Pure. Source: PTU-D46
// Command Reference, version 2.14.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <drivers/pan_tilt/motion.h>

namespace hc::pan_tilt {

inline constexpr double kArcsecondsPerPosition = 185.1428;  ///< of both axes

/// Knows PP TP PO TO PS TS PD TD PA TA PB TB PU TU PL TL PR TR PN TN PX TX, I A H HP HT C CI CV
/// L LE LD E EE ED F FT FV R V O, with and without a value where they have one, in any case. Begins
/// as after being switched on: echo, verbose, limits. It differs from a real one in that R goes to
/// 0, 0 at the pace that is set, without looking for the limits first.
///
/// Positions are the unit's own: pan > 0 to the left, tilt > 0 up. Times [s] do not fall.
class Unit {
 public:
  /// @param pan, tilt  its position, brought within its limits [position].
  explicit Unit(double pan = 0, double tilt = 0);

  /// Takes bytes that came at a time; gives what it answers at once, to all up to an `A` or `R`,
  /// which keeps the rest waiting: up to 256 bytes of it. A word for which there is no room is lost
  /// as a whole.
  std::string take(double time, std::string_view bytes);
  /// What it says by itself up to a time: a motion has ended that was waited for, or at a limit.
  std::string pass(double time);
  /// When pass() has something next, if nothing comes before.
  [[nodiscard]] std::optional<double> next() const;

  /// Where it is [position].
  [[nodiscard]] double pan(double time) const { return axes_[0].motion.at(time).position; }
  [[nodiscard]] double tilt(double time) const { return axes_[1].motion.at(time).position; }

 private:
  struct Axis {
    const char* name;  // "Pan"
    char letter;       // 'P'
    int least, most;   // [position]
    Motion motion;
    int speed = 1000;              // asked for; with a sign under control of speed
    int upper = 2902, lower = 31;  // [position/s]
    bool runs_into_limit = false;  // says so when the motion ends
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
  std::string waiting_;  // not obeyed yet
  bool skips_ = false;   // a word for which there was no room, until it ends
  std::string said_;
  Busy busy_ = Busy::No;
  bool echoes_ = true, verbose_ = true, limits_ = true, controls_speed_ = false;
};

}  // namespace hc::pan_tilt
