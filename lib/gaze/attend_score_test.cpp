// SPDX-License-Identifier: Apache-2.0
#include <gaze/attend_score.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hc::gaze::Attending;
using hc::gaze::TruePerson;

constexpr double kWithin = 0.05;  // [rad]

TruePerson person_at(double error, int number = 1, bool speaks = false, double distance = 2) {
  return {number, {error, 0}, distance, speaks, 1};
}

TEST(AttendScore, of_a_still_face_has_its_overshoot_and_the_time_to_settle) {
  Attending run(kWithin);
  const double errors[] = {0.5, 0.3, 0.04, -0.08, -0.02, 0.01, 0};
  for (int i = 0; i < 7; ++i) run.see(10 + 0.1 * i, {person_at(errors[i])});
  const auto score = run.score();
  EXPECT_NEAR(*score.on_target, 0.2, 1e-9);
  EXPECT_NEAR(score.overshoot, 0.08, 1e-9);
  EXPECT_NEAR(*score.settled, 0.4, 1e-9);
  EXPECT_NEAR(score.rms, std::sqrt((0.0016 + 0.0064 + 0.0004 + 0.0001) / 5), 1e-9);
  EXPECT_NEAR(run.duration(), 0.6, 1e-9);
}

TEST(AttendScore, of_a_head_that_looks_elsewhere_says_so) {
  Attending run(kWithin);
  EXPECT_NE(run.score().text().find("never looked"), std::string::npos) << "an empty room";
  for (int i = 0; i < 9; ++i) run.see(0.1 * i, {person_at(0.5)});
  EXPECT_NE(run.score().text().find("never looked"), std::string::npos);
  EXPECT_FALSE(run.score().settled);
}

TEST(AttendScore, wants_the_one_who_speaks_else_the_nearest) {
  Attending run(kWithin);
  for (int i = 0; i < 100; ++i) {
    const double time = 0.1 * i;
    const bool speaks = i >= 20, second = i >= 50;
    // The head follows the first speech after 0.5 s, and the second after 2 s.
    const double one = (i >= 25 && i < 70) || i < 20 ? 0 : 0.6, two = i >= 70 ? 0 : 0.6;
    run.see(time, {person_at(one, 1, speaks && !second, 3), person_at(two, 2, second, 2.5)});
  }
  const auto score = run.score();
  EXPECT_EQ(score.turns, 2);
  EXPECT_EQ(score.right_turns, 1);
}

}  // namespace
