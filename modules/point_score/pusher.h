// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pushes and releases a stick, and measures when the head starts to move. Pure: times come from the
// caller, in seconds of any one clock.

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gaze/aim.h>
#include <gaze/follower.h>

class Pusher {
 public:
  struct Options {
    int count = 20;              ///< pushes
    std::uint64_t seed = 1;      ///< of the times, lengths and directions of pushes
    hc::gaze::Brakes unit;       ///< it accelerates as it brakes
    double timeout = 2;          ///< a push without motion for longer had no effect [s]
    double min_motion = 2.5e-4;  ///< smaller changes are no motion [rad]
  };
  explicit Pusher(const Options& options) : options_(options), random_(options.seed) {}

  /// Position of the stick.
  struct Stick {
    double left = 0, down = 0;  ///< -1 … 1
  };
  /// Moves the stick when due. Pushes only while the head is at rest.
  ///
  /// @param rate  of repetition while the stick is deflected [Hz].
  /// @returns  the stick, if it is to be sent now.
  std::optional<Stick> look(double time, double rate);
  /// Takes the measured head orientation. @param time  increases.
  void take(double time, const hc::gaze::Angles& angles);

  [[nodiscard]] bool is_done() const { return pushes_ >= options_.count && !pushed_; }
  /// Latency from each push that had an effect to the first motion [s].
  [[nodiscard]] const std::vector<double>& delays() const { return delays_; }
  /// Of the delays.
  struct Score {
    double median = -1, max = -1;  ///< [s]
    std::size_t moved = 0;         ///< pushes that moved the head
    int pushes = 0;

    /// median, max, moved, pushes.
    [[nodiscard]] std::array<double, 4> numbers() const;
    /// "stick to first motion 12.3 ms median, 15.0 ms at most, of 20 of 20 pushes".
    [[nodiscard]] std::string text() const;
  };
  [[nodiscard]] Score score() const;

  /// How long a unit needs from rest for a distance [s].
  /// @param way  distance, >= 0 [rad].
  /// Source: way = base t + a t² / 2.
  static double moving_since(double way, const hc::gaze::Brakes& unit);

 private:
  double random(double least, double most);
  /// Pushes or releases the stick when due. @returns  whether it did.
  bool move(double time);

  Options options_;
  std::mt19937_64 random_;
  std::optional<hc::gaze::Angles> rests_at_;  // since still_since_
  double still_since_ = 0, heard_ = 0;
  double rest_ = 0.5;             // required rest before the next push [s]
  std::optional<double> pushed_;  // time of the push
  double release_ = 0;            // earliest time of the release
  bool moved_ = false;            // since the push
  hc::gaze::Angles from_;         // at the push
  Stick stick_;
  double sent_ = 0;  // when the stick was last sent
  int pushes_ = 0;
  std::vector<double> delays_;
};
