// SPDX-License-Identifier: Apache-2.0
#pragma once
// Estimates and predicts a moving target from noisy, late measurements. Pure.

#include <deque>
#include <optional>

#include <Eigen/Core>

#include <gaze/aim.h>

namespace hc::gaze {

/// The model of a target's motion and measurement.
struct FollowerOptions {
  double noise = 0.003;       ///< standard deviation of a measured angle, > 0 [rad]
  double acceleration = 2.0;  ///< standard deviation of the acceleration, > 0 [rad/s²]
  double gap = 0.5;           ///< after this time unseen, it is another target [s]
  double horizon = 0.2;       ///< how long its rates are extrapolated while unseen [s]
};

/// A target's angles and their rates.
struct Motion {
  Angles angles;
  double pan_rate = 0, tilt_rate = 0;  ///< [rad/s]
};

/// Follows one target with a constant-velocity Kalman filter for each axis, and a slow one, which
/// is used while its predictions in the last second were better: if a target, such as a bouncing
/// ball, oscillates too fast to predict, its mean is a better estimate. Source: Bar-Shalom, Li,
/// Kirubarajan, Estimation with Applications to Tracking, 2001, 6.2.
class Follower {
 public:
  explicit Follower(const FollowerOptions& options) : options_(options) {}

  /// Takes a measurement.
  ///
  /// @param time  of any one clock [s]. Ignored if not after the last one. A time a whole gap
  ///     before it, e.g. because the clock was set back, restarts the filter, and so do angles
  ///     that the target cannot have reached.
  void see(double time, const Angles& angles);
  /// When the target was last seen [s].
  [[nodiscard]] std::optional<double> last() const { return last_; }
  /// The estimate at a time, extrapolated up to the horizon; nothing if never seen.
  [[nodiscard]] std::optional<Motion> at(double time) const;
  void forget() { last_.reset(); }

 private:
  /// One angle and its rate.
  struct Filter {
    Eigen::Vector2d state = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    void begin(double angle, const FollowerOptions& options);
    void step(double dt, const FollowerOptions& options);
    [[nodiscard]] bool can_be(double angle, const FollowerOptions& options) const;
    void correct(double angle, const FollowerOptions& options);
    [[nodiscard]] double after(double dt) const { return state(0) + dt * state(1); }
  };
  /// A quick and a slow filter, and their prediction errors.
  struct Axis {
    Filter quick, slow;
    double quick_error = 0, slow_error = 0;  // mean squares [rad²]
    [[nodiscard]] const Filter& better() const;
  };
  /// The estimates at a time.
  struct Known {
    double time;  // [s]
    Axis pan, tilt;
  };

  void begin(double angle, Axis& axis) const;
  void step(double dt, Axis& axis) const;
  void correct(double angle, Axis& axis) const;
  void judge(double time, const Angles& angles);

  FollowerOptions options_;
  std::optional<double> last_;
  Axis pan_, tilt_;
  std::deque<Known> known_;
};

/// Braking of a unit: at once up to the speed `base`, above with constant deceleration.
struct Brakes {
  double acceleration = 1.795;  ///< over 0 [rad/s²]
  double base = 0;              ///< [rad/s]
};

/// By how much a command must lead a target that moves at `rate`, since the unit brakes to stop at
/// the commanded position: its braking distance [rad].
///
/// @param rate  [rad/s].
/// Source: (v² - base²) / 2a.
inline double braking(double rate, const Brakes& brakes) {
  const double way = (rate * rate - brakes.base * brakes.base) / (2 * brakes.acceleration);
  return way <= 0 ? 0 : rate < 0 ? -way : way;
}

}  // namespace hc::gaze
