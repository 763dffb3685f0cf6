// SPDX-License-Identifier: Apache-2.0
#pragma once
// How an axis with a stepper motor moves: a trapezoid of speed over time, as a function of time.
// Pure. Times are seconds since any one moment and do not fall from call to call; what is true of
// positions is true of any unit.

#include <array>
#include <cstddef>

namespace hc::pan_tilt {

/// How fast an axis goes.
struct Pace {
  double speed = 1000;         ///< greatest [position/s], above 0
  double acceleration = 2000;  ///< of speeding up and of braking [position/s²], above 0
  /// The motor starts and stops with this speed at once, and only above it accelerates; a greater
  /// one than `speed` means `speed` [position/s].
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
  /// Where it is heading, or rests.
  [[nodiscard]] double target() const { return target_; }
  /// When it comes, or came, to rest.
  [[nodiscard]] double end() const { return end_time_; }
  [[nodiscard]] const Pace& pace() const { return pace_; }

  /// Heads for another place from now on; what is too fast to be stopped there goes beyond and
  /// comes back.
  void go(double time, double target);
  /// Continues at another pace.
  void set_pace(double time, const Pace& pace);
  /// Brakes, and stays where that ends.
  void halt(double time);

 private:
  /// A stretch of even acceleration.
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
