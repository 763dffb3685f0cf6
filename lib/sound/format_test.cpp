// SPDX-License-Identifier: Apache-2.0
#include <sound/format.h>

#include <gtest/gtest.h>

namespace {

using hc::audio::coord_of;
using hc::audio::rate_of;

TEST(Format, rates_and_coordinate_systems_R44) {
  EXPECT_EQ(rate_of(20), 8000);
  EXPECT_EQ(rate_of(21), 16000);
  EXPECT_EQ(rate_of(22), 22050);
  EXPECT_EQ(rate_of(23), 44100);
  EXPECT_EQ(rate_of(24), 48000);
  for (int rate : hc::audio::kRates) EXPECT_EQ(rate_of(*coord_of(rate)), rate);
  for (int coord : {-1, 0, 19, 25, 2147483647}) EXPECT_FALSE(rate_of(coord)) << coord;
  for (int rate : {-1, 0, 11025, 96000}) EXPECT_FALSE(coord_of(rate)) << rate;
}

}  // namespace
