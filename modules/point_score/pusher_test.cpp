// SPDX-License-Identifier: Apache-2.0
#include "pusher.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

constexpr double kStep = 1e-3;  // [s]

/// A head that begins to move a while after the push, and stops when the stick is let go.
Pusher play(const Pusher::Options& options, double delay, int* changes = nullptr) {
  Pusher pusher(options);
  double pan = 0, speed = 0, begin = -1, sign = 0;
  for (int i = 0; i < 200000 && !pusher.is_done(); ++i) {
    const double t = kStep * i;
    const auto stick = pusher.look(t);
    if (stick.changed && changes != nullptr) ++*changes;
    if (stick.changed) {
      begin = stick.left == 0 ? -1 : t + delay;
      sign = stick.left > 0 ? 1 : -1;
      speed = 0;
    }
    if (begin >= 0 && t > begin) {
      const double step = std::min(kStep, t - begin);
      const double before = speed == 0 ? options.unit.base : speed;
      speed = before + options.unit.acceleration * step;
      pan += sign * (before + speed) / 2 * step;
    }
    pusher.hear(t, {pan, 0});
  }
  return pusher;
}

TEST(Pusher, finds_when_a_head_begins_to_move) {
  for (double base : {0.0, 0.9}) {
    Pusher::Options options;
    options.unit = {1.795, base};
    int changes = 0;
    const auto pusher = play(options, 0.0123, &changes);
    ASSERT_EQ(pusher.delays().size(), 20U);
    EXPECT_EQ(changes, 40);
    for (double delay : pusher.delays()) EXPECT_NEAR(delay, 0.0123, 1e-3);
  }
}

TEST(Pusher, reports_pushes_without_effect) {
  Pusher::Options options;
  options.count = 3;
  const auto pusher = play(options, 1e9);
  EXPECT_TRUE(pusher.is_done());
  EXPECT_EQ(pusher.pushes(), 3);
  EXPECT_TRUE(pusher.delays().empty());
}

TEST(Pusher, a_unit_has_moved_so_long) {
  EXPECT_DOUBLE_EQ(Pusher::moving_since(0.5, {4, 0}), 0.5);
  EXPECT_DOUBLE_EQ(Pusher::moving_since(0, {4, 0.5}), 0);
  EXPECT_DOUBLE_EQ(Pusher::moving_since(1 * 0.5 + 2 * 0.25, {4, 1}), 0.5);
}

}  // namespace
