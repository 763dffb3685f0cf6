// SPDX-License-Identifier: Apache-2.0
#include "pusher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace {

constexpr double kStep = 1e-3;  // [s]
constexpr double kRate = 50;    // [Hz]

struct Sent {
  double time;
  Pusher::Stick stick;
};

/// A head that starts to move with a delay after the push, and stops when the stick is released.
Pusher play(const Pusher::Options& options, double delay, std::vector<Sent>* all = nullptr) {
  Pusher pusher(options);
  Pusher::Stick held;
  double pan = 0, speed = 0, begin = -1, sign = 0;
  for (int i = 0; i < 200000 && !pusher.is_done(); ++i) {
    const double t = kStep * i;
    const auto stick = pusher.look(t, kRate);
    if (stick && all != nullptr) all->push_back({t, *stick});
    if (stick && stick->left != std::exchange(held, *stick).left) {
      begin = stick->left == 0 ? -1 : t + delay;
      sign = stick->left > 0 ? 1 : -1;
      speed = 0;
    }
    if (begin >= 0 && t > begin) {
      const double step = std::min(kStep, t - begin);
      const double before = speed == 0 ? options.unit.base : speed;
      speed = before + options.unit.acceleration * step;
      pan += sign * (before + speed) / 2 * step;
    }
    pusher.take(t, {pan, 0});
  }
  return pusher;
}

TEST(Pusher, finds_when_a_head_begins_to_move) {
  for (double base : {0.0, 0.9}) {
    Pusher::Options options;
    options.unit = {1.795, base};
    const auto pusher = play(options, 0.0123);
    ASSERT_EQ(pusher.delays().size(), 20U);
    for (double delay : pusher.delays()) EXPECT_NEAR(delay, 0.0123, 1e-3);
  }
}

TEST(Pusher, repeats_the_stick_while_it_is_out_of_its_middle) {
  Pusher::Options options;
  options.unit = {1.795, 0};
  std::vector<Sent> all;
  play(options, 0.01, &all);
  int moves = 1, repeats = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const auto &before = all[i - 1], &now = all[i];
    if (now.stick.left != before.stick.left) {
      ++moves;
      EXPECT_EQ(before.stick.left == 0, now.stick.left != 0) << "it is pushed, or let go";
      continue;
    }
    ++repeats;
    EXPECT_NE(now.stick.left, 0);
    EXPECT_EQ(now.stick.down, before.stick.down);
    EXPECT_NEAR(now.time - before.time, 1 / kRate, 1.5 * kStep);
  }
  EXPECT_EQ(moves, 2 * options.count);
  EXPECT_GE(repeats, options.count * 9) << "each push is of 0.2 s at least";
  EXPECT_EQ(all.back().stick.left, 0);
}

TEST(Pusher, scores_what_moved_the_head) {
  Pusher::Options options;
  options.count = 3;
  options.unit = {1.795, 0};
  const auto score = play(options, 0.0123).score();
  EXPECT_EQ(score.numbers()[2], 3);
  EXPECT_EQ(score.numbers()[3], 3);
  EXPECT_EQ((Pusher::Score{0.0123, 0.015, 19, 20}.text()),
            "stick to first motion 12.3 ms median, 15.0 ms at most, of 19 of 20 pushes");
}

TEST(Pusher, reports_pushes_without_effect) {
  Pusher::Options options;
  options.count = 3;
  const auto pusher = play(options, 1e9);
  EXPECT_TRUE(pusher.is_done());
  EXPECT_EQ(pusher.score().numbers(), (std::array<double, 4>{-1, -1, 0, 3}));
  EXPECT_TRUE(pusher.delays().empty());
}

TEST(Pusher, a_unit_has_moved_so_long) {
  EXPECT_DOUBLE_EQ(Pusher::moving_since(0.5, {4, 0}), 0.5);
  EXPECT_DOUBLE_EQ(Pusher::moving_since(0, {4, 0.5}), 0);
  EXPECT_DOUBLE_EQ(Pusher::moving_since(1 * 0.5 + 2 * 0.25, {4, 1}), 0.5);
}

}  // namespace
