// SPDX-License-Identifier: Apache-2.0
#include <gaze/follow_score.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hc::gaze {
namespace {

std::vector<TimedAngles> turning(double behind, double rate, double offset = 0) {
  std::vector<TimedAngles> samples;
  for (int i = 0; i < static_cast<int>(10 * rate); ++i) {
    const double t = i / rate;
    samples.push_back({t, {0.5 * std::sin(2 * (t - behind)) + offset, 0}});
  }
  return samples;
}

TEST(FollowScore, finds_what_is_behind_and_how_much_that_matters) {
  for (double behind : {-0.02, 0.0, 0.012, 0.25}) {
    const auto score = score_follow(turning(0, 100), turning(behind, 200), 1, 9);
    EXPECT_NEAR(score.behind, behind, 1.5e-3);
    EXPECT_NEAR(score.max, std::abs(behind), 0.05 * std::abs(behind) + 2e-4);  // at 1 rad/s
    EXPECT_EQ(score.samples, 1601U);
  }
}

TEST(FollowScore, an_offset_is_an_error_and_no_delay) {
  // Over two whole periods, so that the offset does not bias the result.
  const auto score = score_follow(turning(0, 100), turning(0, 200, 0.1), 1, 1 + 2 * M_PI);
  EXPECT_NEAR(score.rms, 0.1, 1e-3);
  EXPECT_NEAR(score.behind, 0, 2e-3);
}

TEST(FollowScore, compares_only_what_both_have) {
  EXPECT_EQ(score_follow({}, turning(0, 100), 0, 9).samples, 0U);
  EXPECT_EQ(score_follow(turning(0, 100), {}, 0, 9).samples, 0U);
  EXPECT_EQ(score_follow(turning(0, 100), turning(0, 100), 20, 30).samples, 0U);
  const std::vector<TimedAngles> wanted = {{1, {0, 0}}, {2, {1, 0}}};
  EXPECT_DOUBLE_EQ(angles_at(wanted, 1.5).pan, 0.5);
  EXPECT_DOUBLE_EQ(angles_at(wanted, 0).pan, 0);
  EXPECT_DOUBLE_EQ(angles_at(wanted, 3).pan, 1);
}

}  // namespace
}  // namespace hc::gaze
