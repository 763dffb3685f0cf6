// SPDX-License-Identifier: Apache-2.0
// The persons of the simulated room, seen without errors, give no command while they walk and wave.
#include <people/hand.h>
#include <people/hand_command.h>
#include <room/hand_model.h>
#include <room/people.h>

#include <gtest/gtest.h>

#include <map>

namespace {

using namespace std::chrono_literals;
using hc::people::Hand;
using hc::people::HandCommand;

/// The directions of a right hand from an eye at the height of a head.
HandCommand::Directions seen(const hc::room::Person& person) {
  const auto& hand = person.hands[hc::room::kRight];
  const auto& joints = hc::room::hand_joints(hc::room::kRight, hand.sign);
  const Eigen::Vector3d eye(0, 0, 1.35);
  HandCommand::Directions towards;
  std::size_t next = 0;
  for (const auto joint : {Hand::Wrist, Hand::Middle, Hand::MiddleTip})
    towards[next++] = (hand.T_world_wrist * joints[joint] - eye).normalized();
  return towards;
}

TEST(Waving, in_half_an_hour_of_three_who_walk_is_no_command) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    hc::room::People people({3, "wave", seed});
    std::map<int, HandCommand> commands;
    int count = 0;
    for (hc::Time at{}; at < hc::Time(600s); at += 50ms)
      for (const auto& person : people.at(hc::seconds(at.time_since_epoch())))
        count +=
            commands[person.number].update(at, hc::people::Sign::Open, seen(person)).has_value();
    EXPECT_EQ(count, 0) << "seed " << seed;
  }
}

}  // namespace
