// SPDX-License-Identifier: Apache-2.0
#pragma once
// The motion of an axis with a stepper motor: a trapezoidal speed profile. Pure. Times are seconds
// of any one clock and must not decrease; positions may have any unit.

#include <array>
#include <cstddef>

namespace hc::pan_tilt {

/// Limits of an axis' speed and acceleration.
struct Pace {
  double speed = 1000;         ///< maximum, > 0 [position/s]
  double acceleration = 2000;  ///< also of braking, > 0 [position/s²]
  /// Speed up to which the motor starts and stops at once; limited to `speed` [position/s].
  double base = 0;
};

/// One axis.
///
///     Motion axis(0, {.speed = 1000, .acceleration = 2000});
///     axis.go(0, 500);
///     axis.at(0.3).position;
class Motion {
 public:
  Motion(double position, const Pace& pace);

  struct State {
    double position, speed;  ///< [position], [position/s] with its sign
  };
  [[nodiscard]] State at(double time) const;
  /// Where it moves to, or rests.
  [[nodiscard]] double target() const { return target_; }
  /// When it comes or came to rest.
  [[nodiscard]] double end() const { return end_time_; }
  [[nodiscard]] const Pace& pace() const { return pace_; }

  /// Moves to another position; overshoots and returns if it is too fast to stop there.
  void go(double time, double target);
  /// Continues at another pace.
  void set_pace(double time, const Pace& pace);
  /// Brakes, and stays where it comes to rest.
  void halt(double time);

 private:
  /// A phase of constant acceleration.
  struct Leg {
    double begin, duration, position, speed, acceleration;
    [[nodiscard]] State after(double seconds) const;
  };
  void start(double time, const State& state);
  void add(double speed, double acceleration, double duration);
  void brake();
  void plan();

  Pace pace_;
  double target_;
  std::array<Leg, 5> legs_ = {};  // brake, accelerate or slow down, cruise, brake
  std::size_t count_ = 0;
  double end_time_ = 0, end_position_ = 0, end_speed_ = 0;  // after the last leg
};

}  // namespace hc::pan_tilt
