// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides at whom to look. Pure: times come from the caller.
//
// The rules:
// - A held person comes first, while in view.
// - Then the speaker: the person from whose direction most sound has come.
// - Without a speaker, the nearest person.
// - The choice is kept for a minimum time, a shorter one before a speaker, and another person must
//   be nearer by a margin.
// - After kLife out of view a person has left.

#include <chrono>
#include <map>
#include <optional>
#include <string_view>

#include <hc/base/time.h>

namespace hc::people {

/// Where a person's head is, seen from the robot's.
struct Place {
  double pan = 0;       ///< > 0 to the left, in a frame that does not turn with the head [rad]
  double distance = 0;  ///< [m]
};

class Attention {
 public:
  struct Options {
    std::chrono::nanoseconds hold = std::chrono::seconds(2);  ///< before a nearer person
    std::chrono::nanoseconds hold_from_speaker = std::chrono::milliseconds(300);
    double nearer = 0.4;  ///< how much nearer another must be [m]
  };
  static constexpr std::chrono::milliseconds kLife{1000};
  /// Maximum angle between a sound and the person who makes it [rad].
  static constexpr double kApart = 0.2;

  enum class Reason { Nearest, Speaks, Held };
  struct Choice {
    int track = 0;
    Reason reason = Reason::Nearest;
    bool operator==(const Choice&) const = default;
  };

  explicit Attention(const Options& options) : options_(options) {}

  void set_options(const Options& options) { options_ = options; }
  /// Takes the place of a tracked person at a time.
  void see(int track, Time time, const Place& place);
  /// Takes the direction of a sound, in the frame of Place::pan, > 0 to the left [rad].
  void hear(Time time, double pan);
  /// Holds on to a track whenever it is seen, until release().
  void hold(int track) { held_ = track; }
  void release() { held_.reset(); }

  /// The person to look at; nothing if there is none.
  std::optional<Choice> choose(Time time);

 private:
  struct Person {
    Place place;
    Time seen;
    double heard = 0;  // sounds from there, each of which fades away
    Time heard_at;
  };
  [[nodiscard]] static double speech(const Person& person, Time time);
  [[nodiscard]] std::optional<int> speaker(Time time) const;
  [[nodiscard]] int nearest() const;
  [[nodiscard]] bool is_clearly_nearer(int track, int than) const;
  void look_at(int track, Reason reason, Time time);

  Options options_;
  std::map<int, Person> people_;  // by track
  std::optional<int> held_;
  std::optional<Choice> choice_;
  Time since_;  // choice_
};

/// Why that person: "the nearest", "the speaker", "held".
std::string_view text(Attention::Reason reason);

}  // namespace hc::people
