// SPDX-License-Identifier: Apache-2.0
#include <gaze/track_score.h>

#include <gtest/gtest.h>

namespace hc::gaze {
namespace {

TEST(TrackScore, reports_when_a_ball_is_acquired_and_how_well_it_is_followed) {
  std::vector<TrackSample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back({0.1 * i, i < 5 ? 0.5 : 0.02, 1});
  const auto score = score_track(samples, 0.05);
  ASSERT_TRUE(score.acquired);
  EXPECT_NEAR(*score.acquired, 0.5, 1e-9);
  EXPECT_EQ(score.samples, 95U);
  EXPECT_NEAR(score.rms, 0.02, 1e-9);
  EXPECT_TRUE(score.again.empty());
}

TEST(TrackScore, a_ball_that_hides_is_acquired_again) {
  std::vector<TrackSample> samples;
  for (int i = 0; i < 20; ++i) samples.push_back({0.1 * i, 0.01, 1});
  for (int i = 20; i < 40; ++i) samples.push_back({0.1 * i, 0.3, 0});  // hidden: not counted
  for (int i = 40; i < 60; ++i) samples.push_back({0.1 * i, i < 43 ? 0.3 : 0.01, 1});
  const auto score = score_track(samples, 0.05);
  ASSERT_EQ(score.again.size(), 1U);
  EXPECT_NEAR(score.again[0], 0.3, 1e-9);
  EXPECT_NEAR(score.rms, 0.01, 1e-9);
}

TEST(TrackScore, one_that_is_never_found_is_reported_and_counts) {
  std::vector<TrackSample> samples;
  for (int i = 0; i < 30; ++i) samples.push_back({0.1 * i, 0.4, 1});
  const auto score = score_track(samples, 0.05);
  EXPECT_FALSE(score.acquired);
  EXPECT_NEAR(score.rms, 0.4, 1e-9);
  EXPECT_EQ(score.samples, 19U);  // after the first second
}

TEST(TrackScore, one_that_does_not_come_into_the_middle_again_is_reported) {
  std::vector<TrackSample> samples{{0, 0.01, 1}, {1, 0.01, 0}, {2, 0.3, 1}, {4, 0.3, 1}};
  const auto score = score_track(samples, 0.05);
  ASSERT_EQ(score.again.size(), 1U);
  EXPECT_LT(score.again[0], 0);
}

TEST(TrackScore, one_that_comes_back_when_no_time_is_left_is_no_failure) {
  std::vector<TrackSample> samples{{0, 0.01, 1}, {1, 0.01, 0}, {2, 0.3, 1}, {2.5, 0.3, 1}};
  EXPECT_TRUE(score_track(samples, 0.05).again.empty());
  samples.push_back({2.6, 0.3, 0});
  EXPECT_TRUE(score_track(samples, 0.05).again.empty());
}

TEST(Track, restarts_once_and_lasts_from_its_first_sample_to_its_last) {
  Track track;
  EXPECT_EQ(track.duration(), 0);
  track.add({1, 0.4, 1});
  EXPECT_EQ(track.duration(), 0);
  track.begin();
  track.add({3, 0.01, 1});
  track.begin();
  track.add({5.5, 0.01, 1});
  EXPECT_EQ(track.duration(), 2.5);
  const auto score = track.score(0.05);
  EXPECT_EQ(score.acquired, 0);
  EXPECT_EQ(score.samples, 2U);
}

}  // namespace
}  // namespace hc::gaze
