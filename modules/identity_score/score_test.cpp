// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <gtest/gtest.h>

namespace {

TruePerson person_of(int number, double u, double visible = 1) {
  return {number, u, 200, 60, visible};
}

SeenFace face_of(double u, int track, int known = 0) {
  return {u, 205, track, known};
}

TEST(PersonAt, is_the_one_whose_face_is_there) {
  const std::vector<TruePerson> people = {person_of(1, 100), person_of(2, 300)};
  EXPECT_EQ(person_at(people, face_of(110, 1)), 1);
  EXPECT_EQ(person_at(people, face_of(290, 1)), 2);
  EXPECT_FALSE(person_at(people, face_of(200, 1))) << "no person there";
  EXPECT_FALSE(person_at({}, face_of(200, 1)));
}

TEST(PersonAt, is_the_one_in_front_while_another_is_hidden) {
  EXPECT_EQ(person_at({person_of(1, 100), person_of(2, 104, 0.1)}, face_of(104, 1)), 1);
  EXPECT_EQ(person_at({person_of(1, 104, 0), person_of(2, 100)}, face_of(104, 1)), 2);
}

TEST(PersonAt, is_nobody_while_it_may_be_either) {
  const std::vector<TruePerson> people = {person_of(1, 100), person_of(2, 130, 0.5)};
  EXPECT_FALSE(person_at(people, face_of(114, 1)));
  EXPECT_EQ(person_at(people, face_of(100, 1)), 1);
  EXPECT_EQ(person_at(people, face_of(130, 1)), 2);
}

TEST(PersonsNamed, are_those_whose_names_are_numbers) {
  EXPECT_EQ(persons_named("1 2\n2 1"), (std::map<int, int>{{1, 2}, {2, 1}}));
  EXPECT_EQ(persons_named("3 Anna\n4 1 b\n\n5"), (std::map<int, int>{{3, 0}, {4, 0}}));
  EXPECT_TRUE(persons_named("").empty());
}

TEST(IdentityScore, counts_names_that_are_anothers) {
  IdentityScore score;
  score.set_names({{7, 1}, {8, 2}});
  const std::vector<TruePerson> people = {person_of(1, 100), person_of(2, 300)};
  for (int i = 0; i < 10; ++i) {
    const bool is_swapped = i == 3 || i == 4 || i == 8;
    score.look(people, {face_of(100, 1, 7), face_of(300, 2, is_swapped ? 7 : 8)});
  }
  score.look(people, {face_of(100, 1), face_of(300, 2, 9)});  // 9 is nobody's number
  EXPECT_EQ(score.numbers(), (std::array<double, 5>{22, 21, 4, 3, 0}));
  EXPECT_EQ(score.text(),
            "22 looks, 21 with a name, 4 with another's, 3 names and 0 tracks swapped");
}

TEST(IdentityScore, knows_that_both_are_swapped_all_the_time) {
  IdentityScore score;
  score.set_names({{1, 1}, {2, 2}});
  for (int i = 0; i < 10; ++i)
    score.look({person_of(1, 100), person_of(2, 300)}, {face_of(100, 1, 2), face_of(300, 2, 1)});
  EXPECT_EQ(score.numbers(), (std::array<double, 5>{20, 20, 20, 2, 0}));
}

TEST(IdentityScore, counts_no_name_before_it_knows_whose_they_are) {
  IdentityScore score;
  score.look({person_of(1, 100)}, {face_of(100, 1, 1)});
  EXPECT_EQ(score.numbers(), (std::array<double, 5>{1, 0, 0, 0, 0}));
}

TEST(IdentityScore, counts_a_track_that_goes_on_with_another_person) {
  IdentityScore score;
  score.look({person_of(1, 100), person_of(2, 300)}, {face_of(100, 1), face_of(300, 2)});
  // One hides the other, and the track of the hidden one takes over the face in front.
  score.look({person_of(1, 200, 0), person_of(2, 200)}, {face_of(200, 2)});
  score.look({person_of(1, 200, 0), person_of(2, 200)}, {face_of(200, 1)});
  score.look({person_of(1, 300), person_of(2, 100)}, {face_of(100, 1), face_of(300, 3)});
  EXPECT_EQ(score.numbers()[4], 1);
  score.look({person_of(1, 300), person_of(2, 100)}, {face_of(100, 3), face_of(300, 1)});
  EXPECT_EQ(score.numbers()[4], 3) << "both are back at the wrong one";
}

TEST(IdentityScore, says_that_nobody_was_found) {
  IdentityScore score;
  score.look({person_of(1, 100)}, {face_of(600, 1, 1)});
  EXPECT_EQ(score.text(), "no person's face was found");
}

}  // namespace
