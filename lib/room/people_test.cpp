// SPDX-License-Identifier: Apache-2.0
#include <room/people.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <room/hand_model.h>
#include <room/pointing.h>

namespace hc::room {

namespace {

using Eigen::Vector3d;

constexpr double kTick = 0.02;       // [s]
constexpr double kRobotHead = 1.25;  // height [m]
const Vector3d kRobotEyes(0.06, 0, kRobotHead);

/// Angle between where a face looks and the robot, seen from above [rad].
double turned_away(const Person& person) {
  const Vector3d ahead = person.T_world_face.linear().col(0);
  const Vector3d to_robot = kRobotEyes - person.T_world_face.translation();
  const double angle = std::atan2(ahead.y(), ahead.x()) - std::atan2(to_robot.y(), to_robot.x());
  return std::abs(std::remainder(angle, 2 * 3.14159265358979));
}

class EachMotion : public testing::TestWithParam<const char*> {};

TEST_P(EachMotion, keeps_people_apart_within_their_space_and_facing_the_robot) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    People people({3, GetParam(), seed});
    for (double t = 0; t < 40; t += 0.1) {
      const auto all = people.at(t);
      ASSERT_EQ(all.size(), 3U);
      for (const auto& person : all) {
        const Vector3d feet = person.T_world_body.translation();
        EXPECT_EQ(feet.z(), 0);
        EXPECT_GE(feet.x(), 1.9);
        EXPECT_LE(feet.x(), 3);
        EXPECT_LE(std::abs(feet.y()), kWalkEnd + 1e-9);
        EXPECT_LE(turned_away(person), 0.7) << t;  // 40°
        for (const auto& other : all) {
          if (&other == &person) continue;
          EXPECT_GT((other.T_world_body.translation() - feet).norm(), 0.45) << t;
        }
      }
    }
  }
}

TEST_P(EachMotion, is_the_same_for_a_seed_whenever_it_is_asked) {
  People forward({2, GetParam(), 5}), at_once({2, GetParam(), 5});
  for (double t = 0; t < 20; t += kTick) (void)forward.at(t);
  for (double t : {19.5, 3.25}) {
    const auto some = forward.at(t), others = at_once.at(t);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_TRUE(some[i].T_world_face.isApprox(others[i].T_world_face, 0));
      EXPECT_TRUE(
          some[i].hands[kRight].T_world_wrist.isApprox(others[i].hands[kRight].T_world_wrist, 0));
      EXPECT_EQ(some[i].speaks, others[i].speaks);
    }
  }
}

TEST_P(EachMotion, never_jumps) {
  People people({3, GetParam(), 2});
  auto last = people.at(0);
  for (double t = kTick; t < 30; t += kTick) {
    auto now = people.at(t);
    for (std::size_t i = 0; i < now.size(); ++i) {
      EXPECT_LE((now[i].T_world_face.translation() - last[i].T_world_face.translation()).norm(),
                1.8 * kTick);
      for (const auto side : {0U, 1U})
        EXPECT_LE((now[i].hands[side].T_world_wrist.translation() -
                   last[i].hands[side].T_world_wrist.translation())
                      .norm(),
                  4.5 * kTick)
            << t;
    }
    last = std::move(now);
  }
}

TEST_P(EachMotion, bends_the_arms_without_stretching_them) {
  People people({3, GetParam(), 4});
  for (double t = 0; t < 30; t += 0.05)
    for (const auto& person : people.at(t))
      for (const int side : {kLeft, kRight}) {
        const Vector3d top = person.T_world_body * shoulder(look_of(person.number), side);
        const auto& hand = person.hands[static_cast<std::size_t>(side)];
        EXPECT_LE((hand.T_world_wrist.translation() - top).norm(), kUpperArm + kForearm + 0.001);
      }
}

INSTANTIATE_TEST_SUITE_P(People, EachMotion,
                         testing::Values("still", "walk", "cross", "wave", "talk", "point", "palm",
                                         "thumb", "fist", "victory"));

TEST(Walking, is_at_one_metre_a_second_across_three_metres) {
  People people({1, "cross", 3});
  double fastest = 0, left = 0, right = 0;
  for (double t = 0; t < 30; t += kTick) {
    const auto person = people.at(t).front();
    fastest = std::max(fastest, person.speed);
    left = std::max(left, person.T_world_body.translation().y());
    right = std::min(right, person.T_world_body.translation().y());
  }
  EXPECT_NEAR(fastest, kWalkSpeed, 1e-9);
  EXPECT_NEAR(left - right, 2.9, 0.01);
}

TEST(Talking, is_by_one_at_a_time_in_turns_and_heard_when_it_is_seen) {
  People people({3, "talk", 6});
  std::set<int> speakers;
  int silent = 0;
  for (double t = 0; t < 60; t += kTick) {
    const auto all = people.at(t);
    const auto speaks = std::ranges::count_if(all, &Person::speaks);
    EXPECT_LE(speaks, 1);
    silent += speaks == 0;
    for (const auto& person : all) {
      if (person.speaks) speakers.insert(person.number);
      if (!person.speaks) {
        EXPECT_EQ(people.voice_of(person.number, t), 0);
      }
    }
  }
  EXPECT_EQ(speakers.size(), 3U);
  EXPECT_GT(silent, 100);
  double loudest = 0;
  for (double t = 0; t < 10; t += 1e-3)
    for (int i = 0; i < 3; ++i) loudest = std::max(loudest, std::abs(people.voice_of(i, t)));
  EXPECT_GT(loudest, 0.5);
}

TEST(Pointing, aims_eye_fingertip_and_finger_at_a_thing_1_to_3_m_away) {
  int held = 0;
  std::set<double> places;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    People people({3, "point", seed});
    for (double t = 0; t < 40; t += 0.1)
      for (const auto& person : people.at(t)) {
        if (!person.pointed) continue;
        ++held;
        const Vector3d place = *person.pointed, eyes = person.T_world_face.translation();
        places.insert(place.x());
        const int side = pointing_side(person, place);
        const Hand& hand = person.hands[static_cast<std::size_t>(side)];
        ASSERT_EQ(hand.sign, Sign::Point);
        const auto& joints = hand_joints(side, Sign::Point);
        const Vector3d tip = hand.T_world_wrist * joints[kIndexTip];
        const Vector3d root = hand.T_world_wrist * joints[kIndexRoot];
        auto angle = [&](const Vector3d& from) {
          return std::acos(
              std::min(1.0, (tip - from).normalized().dot((place - tip).normalized())));
        };
        EXPECT_LE(angle(eyes), 0.001);
        EXPECT_LE(angle(root), 0.001);
        EXPECT_GE((place - hand.T_world_wrist.translation()).norm(), 1);
        EXPECT_LE((place - hand.T_world_wrist.translation()).norm(), 3);
      }
  }
  EXPECT_GT(held, 1000);
  EXPECT_GE(places.size(), 4U);
}

TEST(Signs, are_shown_by_each_hand_of_everybody) {
  People people({2, "palm", 3});
  std::set<std::pair<int, int>> hands;
  for (double t = 0; t < 60; t += 0.1)
    for (const auto& person : people.at(t))
      for (const int side : {kLeft, kRight})
        if (person.hands[static_cast<std::size_t>(side)].sign == Sign::Open)
          hands.emplace(person.number, side);
  EXPECT_EQ(hands.size(), 4U);
}

TEST(Signs, are_held_still_but_a_wave_never_is) {
  for (const bool waves : {false, true}) {
    People people({1, waves ? "wave" : "palm", 2});
    double still = 0, longest = 0;
    Vector3d last = Vector3d::Zero();
    for (double t = 0; t < 30; t += kTick) {
      const auto person = people.at(t).front();
      const Hand& hand = person.hands[kRight];
      const Vector3d tip =
          (person.T_world_body.inverse() * hand.T_world_wrist) * hand_joints(kRight, hand.sign)[12];
      const bool rests = hand.sign == Sign::Open && (tip - last).norm() < 0.1 * kTick;
      still = rests ? still + kTick : 0;
      longest = std::max(longest, still);
      last = tip;
    }
    EXPECT_EQ(longest > 0.1, !waves);
    EXPECT_EQ(longest > 1.7, !waves);
  }
}

}  // namespace

}  // namespace hc::room
