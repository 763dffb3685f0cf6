// SPDX-License-Identifier: Apache-2.0
#include "nod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

TEST(Nod, begins_at_rest_in_the_middle) {
  for (double time : {-1.0, 0.0, 0.01}) {
    EXPECT_NEAR(angles_at({}, time).yaw, 0, 1e-4);
    EXPECT_NEAR(angles_at({}, time).pitch, 0, 1e-4);
  }
}

TEST(Nod, has_its_amplitude_and_speed_and_less_acceleration_than_the_unit) {
  constexpr double kUnit = 1.795;  // [rad/s²]
  constexpr double kStep = 1e-3;   // [s]
  double yaw = 0, pitch = 0, speed = 0, acceleration = 0;
  for (int i = 1; i < 20000; ++i) {
    const double t = kStep * i;
    const auto before = angles_at({}, t - kStep), now = angles_at({}, t),
               after = angles_at({}, t + kStep);
    yaw = std::max(yaw, std::abs(now.yaw));
    pitch = std::max(pitch, std::abs(now.pitch));
    speed = std::max(speed, std::abs(after.yaw - now.yaw) / kStep);
    for (double change :
         {after.yaw - 2 * now.yaw + before.yaw, after.pitch - 2 * now.pitch + before.pitch})
      acceleration = std::max(acceleration, std::abs(change) / (kStep * kStep));
  }
  EXPECT_NEAR(yaw, 0.7, 1e-3);
  EXPECT_NEAR(pitch, 0.175, 1e-3);
  EXPECT_NEAR(speed, 1.047, 1e-3);
  EXPECT_GT(acceleration, 1.5);
  EXPECT_LT(acceleration, kUnit);
}

}  // namespace
