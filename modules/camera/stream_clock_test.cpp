// SPDX-License-Identifier: Apache-2.0
#include "stream_clock.h"

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;
using Nanoseconds = std::chrono::nanoseconds;

constexpr auto kImagePeriod = 50ms;  // of the images

/// When the image of a time arrives if images come in bursts.
hc::MonotonicTime in_bursts_of(Nanoseconds time, milliseconds burst) {
  return hc::MonotonicTime(((time + burst - 1ns) / burst) * Nanoseconds(burst));
}

TEST(StreamClock, images_that_arrive_in_bursts_keep_their_distances) {
  StreamClock clock;
  for (int i = 0; i < 1000; ++i) {
    const auto taken = 7s + i * kImagePeriod;
    const auto time = clock.time_of(i * kImagePeriod, in_bursts_of(taken, 100ms));
    EXPECT_EQ(time, i > 2 ? taken : time) << i;
  }
}

TEST(StreamClock, a_jam_changes_nothing) {
  StreamClock clock;
  for (int i = 0; i < 1000; ++i) {
    const auto taken = 7s + i * kImagePeriod;
    const bool is_jammed = i >= 400 && i < 440;
    const auto arrived = is_jammed ? 7s + 440 * kImagePeriod : taken + 3ms;
    EXPECT_EQ(clock.time_of(i * kImagePeriod, arrived), taken + 3ms) << i;
  }
}

TEST(StreamClock, what_was_kept_for_the_first_reader_is_not_in_the_future) {
  // A server sends the last 20 images at once.
  StreamClock clock;
  hc::MonotonicTime last{0};
  for (int i = 0; i < 100; ++i) {
    const auto arrived = 7s + std::max(0, i - 19) * kImagePeriod;
    const auto time = clock.time_of(i * kImagePeriod, arrived);
    EXPECT_GE(time, last);
    EXPECT_LE(time, arrived);
    last = time;
    EXPECT_EQ(time, i >= 19 ? arrived : time) << i;
  }
}

TEST(StreamClock, a_clock_that_drifts_is_followed) {
  for (const double drift : {100e-6, -100e-6}) {
    StreamClock clock;
    for (int i = 0; i < 36000; ++i) {
      const auto taken = 7s + i * kImagePeriod;
      const auto streamed = hc::duration(hc::seconds(i * kImagePeriod) * (1 + drift));
      EXPECT_NEAR(hc::seconds(clock.time_of(streamed, taken) - taken), 0, 2.1e-3) << i;
    }
  }
}

TEST(StreamClock, a_stream_that_starts_again_gets_new_times) {
  StreamClock clock;
  EXPECT_EQ(clock.time_of(100s, 7s), 7s);
  EXPECT_EQ(clock.time_of(0s, 8s), 8s);
  EXPECT_EQ(clock.time_of(kImagePeriod, 9s), 8s + kImagePeriod);
  // Its clock has been set forward.
  EXPECT_EQ(clock.time_of(1000s, 10s), 10s);
  EXPECT_EQ(clock.time_of(1001s, 11s), 11s);
}

}  // namespace
