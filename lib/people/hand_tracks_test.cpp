// SPDX-License-Identifier: Apache-2.0
#include <people/hand_tracks.h>

#include <gtest/gtest.h>

#include <utility>

#include <people/made_hand_test.h>

namespace hc::people {
namespace {

using namespace std::chrono_literals;

constexpr Time kFirstSeen{100s};

TEST(HandTracks, keep_the_number_of_a_hand_that_was_looked_for) {
  HandTracks tracks;
  const auto first =
      tracks.update(kFirstSeen, {{0, made_hand({}, {100, 300})}, {0, made_hand({}, {500, 300})}});
  ASSERT_EQ(first.size(), 2U);
  EXPECT_EQ(first[0].number, 1);
  EXPECT_EQ(first[1].number, 2);
  const auto next = tracks.update(kFirstSeen + 50ms, {{2, made_hand({}, {400, 300})}});
  ASSERT_EQ(next.size(), 1U);
  EXPECT_EQ(next[0].number, 2);
  EXPECT_EQ(next[0].seen, kFirstSeen + 50ms);
}

TEST(HandTracks, are_expected_where_they_move_to) {
  HandTracks tracks;
  tracks.update(kFirstSeen, {{0, made_hand({}, {100, 300})}});
  const Region rest = tracks.expected(kFirstSeen + 100ms).at(0).region;
  for (int i = 1; i < 12; ++i)
    tracks.update(kFirstSeen + i * 50ms,
                  {{1, made_hand({}, {100 + 10 * static_cast<float>(i), 300})}});
  const Region moved = tracks.expected(kFirstSeen + 600ms).at(0).region;
  EXPECT_NEAR(moved.middle.x, rest.middle.x + 120, 1) << "200 px/s";
  EXPECT_NEAR(moved.middle.y, rest.middle.y, 1e-3);
  EXPECT_NEAR(moved.side, rest.side, 1e-3);
  const Region lost = tracks.expected(kFirstSeen + 1500ms).at(0).region;
  EXPECT_NEAR(lost.middle.x, rest.middle.x + 110 + 60, 1) << "where it was after 0.3 s";
}

TEST(HandTracks, stay_where_images_come_at_almost_one_time) {
  HandTracks tracks;
  tracks.update(kFirstSeen, {{0, made_hand({}, {100, 300})}});
  tracks.update(kFirstSeen + 1us, {{1, made_hand({}, {105, 300})}});
  const Region there = region_of(made_hand({}, {105, 300}));
  EXPECT_NEAR(tracks.expected(kFirstSeen + 50ms).at(0).region.middle.x, there.middle.x, 1);
}

TEST(HandTracks, continue_a_lost_hand_that_a_new_one_overlaps) {
  HandTracks tracks;
  tracks.update(kFirstSeen, {{0, made_hand({})}});
  EXPECT_TRUE(tracks.update(kFirstSeen + 100ms, {}).empty());
  EXPECT_EQ(tracks.expected(kFirstSeen + 200ms).size(), 1U);
  EXPECT_EQ(tracks.update(kFirstSeen + 200ms, {{0, made_hand({}, {420, 300})}}).at(0).number, 1);
}

TEST(HandTracks, continue_the_lost_hand_that_a_new_one_overlaps_most) {
  HandTracks tracks;
  tracks.update(kFirstSeen, {{0, made_hand({}, {400, 300})}, {0, made_hand({}, {440, 300})}});
  tracks.update(kFirstSeen + 50ms, {});
  const auto one = tracks.update(kFirstSeen + 100ms, {{0, made_hand({}, {436, 300})}});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].number, 2);
  tracks.update(kFirstSeen + 150ms, {});
  const auto both = tracks.update(kFirstSeen + 200ms,
                                  {{0, made_hand({}, {430, 300})}, {0, made_hand({}, {395, 300})}});
  ASSERT_EQ(both.size(), 2U) << "the first of them overlaps both";
  EXPECT_LT(both[0].hand.points[0].x, both[1].hand.points[0].x);
}

TEST(HandTracks, that_are_lost_do_not_continue_in_a_hand_beside_them) {
  const float width = made_hand({}).box().width;
  for (const auto& [shift, number] : {std::pair(0.5F, 1), std::pair(0.8F, 2)}) {
    HandTracks tracks;
    tracks.update(kFirstSeen, {{0, made_hand({}, {400, 300})}});
    tracks.update(kFirstSeen + 50ms, {});
    const Hand beside = made_hand({}, {400 + shift * width, 300});
    EXPECT_EQ(tracks.update(kFirstSeen + 100ms, {{0, beside}}).at(0).number, number) << shift;
  }
}

TEST(HandTracks, that_are_lost_take_no_hand_that_is_followed) {
  HandTracks tracks;
  tracks.update(kFirstSeen, {{0, made_hand({}, {400, 300})}, {0, made_hand({}, {600, 300})}});
  tracks.update(kFirstSeen + 50ms, {{2, made_hand({}, {500, 300})}});
  const auto one = tracks.update(kFirstSeen + 100ms, {{2, made_hand({}, {405, 300})}});
  ASSERT_EQ(one.size(), 1U) << "where the other one was";
  EXPECT_EQ(one[0].number, 2);
  const auto same = tracks.update(kFirstSeen + 150ms,
                                  {{1, made_hand({}, {405, 300})}, {2, made_hand({}, {405, 300})}});
  ASSERT_EQ(same.size(), 1U);
  EXPECT_EQ(same[0].number, 2) << "the hand where the lost one was expected is the other one";
}

TEST(HandTracks, end_and_their_numbers_are_not_used_again) {
  HandTracks tracks;
  tracks.update(kFirstSeen, {{0, made_hand({})}});
  const auto later = kFirstSeen + HandTracks::kLife + 1ms;
  EXPECT_TRUE(tracks.expected(later).empty());
  EXPECT_EQ(tracks.update(later, {{0, made_hand({})}}).at(0).number, 2);
  EXPECT_EQ(tracks.update(kFirstSeen, {{0, made_hand({})}}).at(0).number, 3) << "time went back";
}

TEST(HandTracks, of_one_hand_are_one) {
  HandTracks tracks;
  EXPECT_EQ(tracks.update(kFirstSeen, {{0, made_hand({})}, {0, made_hand({}, {405, 300})}}).size(),
            1U);
  tracks.update(kFirstSeen, {{0, made_hand({}, {600, 300})}});
  const auto both =
      tracks.update(kFirstSeen + 50ms, {{1, made_hand({})}, {2, made_hand({}, {405, 300})}});
  ASSERT_EQ(both.size(), 1U);
  EXPECT_EQ(both[0].number, 1) << "the older one";
  EXPECT_EQ(tracks.expected(kFirstSeen + 50ms).size(), 1U);
}

}  // namespace
}  // namespace hc::people
