// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the persons in the room do over time. Pure: the same seed gives the same scene.

#include <cstdint>
#include <string>
#include <vector>

#include <room/person.h>
#include <room/turns.h>
#include <room/walk.h>

namespace hc::room {

struct PeopleMotion {
  int count = 0;  ///< of persons, at most kMostPeople
  /// still; walk (to and fro), cross (all walk from end to end), wave (walk and wave); talk (in
  /// turns), point (at things, in turns); palm, thumb, fist, victory (show that sign, in turns)
  std::string kind = "still";
  std::uint64_t seed = 1;
};

class People {
 public:
  explicit People(const PeopleMotion& motion);

  /// The persons at a time, each with its number [s].
  [[nodiscard]] std::vector<Person> at(double t);
  /// The sound of a person's mouth, with amplitude 1. 0 while the person does not speak.
  [[nodiscard]] double voice_of(int person, double t);

 private:
  [[nodiscard]] Person standing(int number) const;
  [[nodiscard]] Person walking(int number, double t);
  void act(Person& person, double t);

  PeopleMotion motion_;
  bool walk_ = false;
  Sign sign_ = Sign::Relaxed;            // that is shown in turns
  std::vector<Walk> walks_;              // of each person
  std::vector<Eigen::Vector2d> places_;  // of persons who stand
  Turns turns_;
};

/// The mouth in the world [m].
Eigen::Vector3d mouth_of(const Person& person);

/// Seconds that a hand takes to rise, and to sink.
inline constexpr double kRise = 0.6;

}  // namespace hc::room
