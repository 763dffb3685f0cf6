// SPDX-License-Identifier: Apache-2.0
#pragma once
// What moves, as it is seen with noise and late: where it is now and will be. Pure.

#include <deque>
#include <optional>

#include <Eigen/Core>

#include <gaze/aim.h>

namespace hc::gaze {

/// What is known of how a target moves and is seen.
struct FollowerOptions {
  double noise = 0.003;       ///< standard deviation of an angle as it is seen, over 0 [rad]
  double acceleration = 2.0;  ///< standard deviation of its acceleration, over 0 [rad/s²]
  double gap = 0.5;           ///< unseen for longer, it is another target [s]
  double horizon = 0.2;       ///< how long its rates are extrapolated while unseen [s]
};

/// A target's angles and their rates.
struct Motion {
  Angles angles;
  double pan_rate = 0, tilt_rate = 0;  ///< [rad/s]
};

/// Follows one target: for each axis a Kalman filter of constant velocity, and a slow one, which is
/// taken while its predictions of the last second were the better ones: of what goes to and fro
/// faster than can be predicted, as a ball that bounces, the middle is nearer than the last
/// velocity. Source: Bar-Shalom, Li, Kirubarajan, Estimation with Applications to Tracking,
/// 2001, 6.2.
class Follower {
 public:
  explicit Follower(const FollowerOptions& options) : options_(options) {}

  /// Takes in where the target was.
  ///
  /// @param time  [s], of any origin. A time not after the last is ignored; a time a whole gap
  ///     before it, as when the clock was set back, restarts the filter, and so does a place that
  ///     the target cannot have reached.
  void see(double time, const Angles& angles);
  /// When it was last seen [s].
  [[nodiscard]] std::optional<double> last() const { return last_; }
  /// Where it is taken to be at a time, its last rates going on up to the
  /// horizon. Nothing: never seen.
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
  /// A quick filter and a slow one, and how well they predict.
  struct Axis {
    Filter quick, slow;
    double quick_error = 0, slow_error = 0;  // mean squares [rad²]
    [[nodiscard]] const Filter& better() const;
  };
  /// What was known at a time.
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

/// How a unit stops: with `base` at once, and faster than that only with an even acceleration.
struct Brakes {
  double acceleration = 1.795;  ///< over 0 [rad/s²]
  double base = 0;              ///< [rad/s]
};

/// By how much a command has to be ahead of a place that moves at `rate`, for a unit that brakes to
/// stop where it is sent: its braking distance. [rad]
///
/// @param rate  [rad/s].
/// Source: (v² - base²) / 2a.
inline double braking(double rate, const Brakes& brakes) {
  const double way = (rate * rate - brakes.base * brakes.base) / (2 * brakes.acceleration);
  return way <= 0 ? 0 : rate < 0 ? -way : way;
}

}  // namespace hc::gaze
