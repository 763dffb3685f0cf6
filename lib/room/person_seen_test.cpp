// SPDX-License-Identifier: Apache-2.0
#include <room/person_seen.h>

#include <gtest/gtest.h>

#include <room/people.h>

namespace hc::room {

namespace {

using Eigen::Vector3d;

bool everywhere(const Vector3d& /*point*/) {
  return true;
}

class PersonSeen : public testing::Test {
 protected:
  /// Moves a person with all parts.
  static void move(Person& person, const Vector3d& by) {
    person.T_world_body.pretranslate(by);
    person.T_world_face.pretranslate(by);
    for (auto& hand : person.hands) hand.T_world_wrist.pretranslate(by);
  }
  std::vector<Person> all = People({2, "still", 1}).at(0);
  Vector3d eye{0.06, 0, 1.6};
};

TEST_F(PersonSeen, is_whole_beside_another) {
  EXPECT_EQ(face_seen(all, 0, eye, everywhere), 1);
  EXPECT_EQ(face_seen(all, 1, eye, everywhere), 1);
}

TEST_F(PersonSeen, is_hidden_behind_another_and_not_before) {
  const Vector3d first = all[0].T_world_face.translation();
  move(all[1], (0.8 * (first - eye) + eye) - all[1].T_world_face.translation());
  EXPECT_LT(face_seen(all, 0, eye, everywhere), 0.1);
  EXPECT_EQ(face_seen(all, 1, eye, everywhere), 1);
  move(all[1], {0, 0.08, 0});
  EXPECT_NEAR(face_seen(all, 0, eye, everywhere), 0.5, 0.35);
}

TEST_F(PersonSeen, is_hidden_behind_a_hand_also_the_own) {
  const Vector3d face = all[0].T_world_face * Vector3d(0, 0, -0.03);
  all[0].hands[kRight].T_world_wrist =
      wrist(face + 0.3 * (eye - face).normalized() - Vector3d(0, 0, 0.06), {0, 0, 1}, {1, 0, 0});
  const double seen = face_seen(all, 0, eye, everywhere);
  EXPECT_GT(seen, 0.1);
  EXPECT_LT(seen, 0.8);
}

TEST_F(PersonSeen, counts_only_points_in_view) {
  const double middle = all[0].T_world_face.translation().y();
  const double half =
      face_seen(all, 0, eye, [&](const Vector3d& point) { return point.y() < middle; });
  EXPECT_NEAR(half, 0.5, 0.1);
}

}  // namespace

}  // namespace hc::room
