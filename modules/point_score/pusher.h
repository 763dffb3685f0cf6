// SPDX-License-Identifier: Apache-2.0
#pragma once
// Pushes a stick and releases it, and measures when the head begins to move. Pure: the caller
// gives the time. Times are seconds of any origin.

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
    std::uint64_t seed = 1;      ///< of when, how long and where to
    hc::gaze::Brakes unit;       ///< how the unit speeds up, too
    double timeout = 2;          ///< without motion for so long, a push had no effect [s]
    double min_motion = 2.5e-4;  ///< as which a motion counts [rad]
  };
  explicit Pusher(const Options& options) : options_(options), random_(options.seed) {}

  /// Position of the stick.
  struct Stick {
    double left = 0, down = 0;  ///< -1 … 1
  };
  /// Moves the stick when it is time. Nothing is pushed before the head is at rest.
  ///
  /// @param rate  how often the stick is repeated while it is out of its middle [Hz].
  /// @returns  what is to be sent now: the stick, where it has moved or is to be repeated.
  std::optional<Stick> look(double time, double rate);
  /// Takes the measured head orientation. @param time  grows.
  void take(double time, const hc::gaze::Angles& angles);

  [[nodiscard]] bool is_done() const { return pushes_ >= options_.count && !pushed_; }
  /// From a push to the first motion, each but those that had no effect. [s]
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

  /// How long a unit has moved from rest when it has come so far [s].
  /// @param way  not below 0 [rad].
  /// Source: way = base t + a t² / 2.
  static double moving_since(double way, const hc::gaze::Brakes& unit);

 private:
  double random(double least, double most);
  /// Pushes the stick or lets it go. @returns  whether it did.
  bool move(double time);

  Options options_;
  std::mt19937_64 random_;
  std::optional<hc::gaze::Angles> rests_at_;  // since still_since_
  double still_since_ = 0, heard_ = 0;
  double rest_ = 0.5;             // for which it has to be at rest before the next push [s]
  std::optional<double> pushed_;  // when
  double release_ = 0;            // when, at the earliest
  bool moved_ = false;            // since then
  hc::gaze::Angles from_;         // where it stood then
  Stick stick_;
  double sent_ = 0;  // when the stick was, last
  int pushes_ = 0;
  std::vector<double> delays_;
};
