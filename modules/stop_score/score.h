// SPDX-License-Identifier: Apache-2.0
#pragma once
// Compares the stops of a robot with the palms that persons hold up before it. Pure: times come
// from the caller.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <room/truth_rows.h>

/// A hand that the simulation shows.
struct ShownHand {
  hc::room::TrueHand hand;
  bool is_in_image = false;  ///< all of it
};

/// Whether a hand is open, with its fingers up.
bool is_palm_up(const hc::room::TrueHand& hand);

/// Collects a run. A palm counts from the first image in which it is in sight, open, up, and where
/// it then stays; one that stays for less than kHeld is no command, and one that is held when the
/// robot is stopped already stops nothing. One that is not whole in the image may stop the robot or
/// not: such a stop is counted apart.
class StopScore {
 public:
  /// How far a palm that is held still moves at most [m].
  static constexpr double kStill = 0.02;
  /// How long it is held at least until it may stop the robot, and until it has to [s].
  static constexpr double kHeld = 0.3, kMustStop = 0.8;
  /// How long after its end a stop still belongs to a palm [s].
  static constexpr double kLate = 1;

  /// Takes the hands of an image.
  void see(double time, const std::vector<ShownHand>& hands);
  /// The robot is stopped, since or at a time [s]; repeated calls are ignored.
  void stop(double time);
  /// The robot is free again.
  void go() { is_stopped_ = false; }
  /// Whether the stop can be cleared: no palm has been up for half a second.
  [[nodiscard]] bool wants_to_go(double now) const;

  /// From the first image to the last [s].
  [[nodiscard]] double duration() const { return begin_ ? last_ - *begin_ : 0; }

  /// Median and maximum time from a palm to its stop [s], -1 without; palms that stopped the robot,
  /// palms held, stops without a palm, stops by one that is not whole in the image, and duration
  /// [s].
  [[nodiscard]] std::array<double, 7> numbers() const;
  /// "missed 0 of 12 palms, stopped after 0.580 s median, 0.630 s at most; 0 stops without a palm,
  /// 1 by one at the border, in 60 s"; without a palm only its end.
  [[nodiscard]] std::string text() const;

 private:
  struct Palm {
    std::pair<int, int> whose;            // person, and side
    double begin = 0, seen = 0;           // [s]
    Eigen::Vector3d at;                   // its wrist [m]
    bool is_in_image = true;              // whole; again kHeld after it was not
    std::optional<double> whole_since{};  // of one that was not [s]
    bool is_up = true;                    // in the last image
    bool has_stopped = false;
    /// Takes whether the whole palm is in an image; after kHeld inside, its time starts again. One
    /// that must have stopped the robot already is not excused.
    void see_border(double time, bool is_whole);
    [[nodiscard]] bool is_held() const { return seen - begin >= kHeld; }
    [[nodiscard]] bool must_stop() const { return is_in_image && seen - begin >= kMustStop; }
  };
  void see_palm(double time, const ShownHand& shown);
  void drop_ended(double time);

  std::vector<Palm> palms_;  // those up, and those whose stop may still come
  std::optional<double> begin_;
  double last_ = 0;     // image
  double palm_ = -1e9;  // last image with a palm up
  bool is_stopped_ = false;
  std::vector<double> delays_;
  int missed_ = 0, false_ = 0, at_border_ = 0;
};
