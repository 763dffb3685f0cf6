// SPDX-License-Identifier: Apache-2.0
#include <people/track_views.h>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using hc::people::Embedding;
using hc::people::FaceTracks;
using hc::people::Track;
using hc::people::TrackViews;

Embedding view(float first) {
  Embedding made = {};
  made[0] = first;
  return made;
}

class TrackViewsTest : public testing::Test {
 protected:
  Track track(int number, float x) const {
    Track made;
    made.number = number;
    made.face.box = {x, 100, 60, 60};
    made.seen = now_;
    return made;
  }
  static std::vector<FaceTracks::Expected> expected(const std::vector<Track>& tracks) {
    std::vector<FaceTracks::Expected> all;
    for (const Track& each : tracks) all.push_back({each.number, each.face.box});
    return all;
  }
  /// Looks at tracks 1 and 2, whose faces have these embeddings, for some images.
  void look(int images, float x, float first, float second) {
    for (int i = 0; i < images; ++i) {
      now_ += 50ms;
      const std::vector<Track> seen{track(1, 100), track(2, x)};
      const auto due = views_.due(now_, seen, expected(seen));
      if (!due) continue;
      ++described_;
      views_.add(*due == 0 ? 1 : 2, now_, view(*due == 0 ? first : second));
    }
  }
  TrackViews views_;
  hc::Time now_{1'700'000'000s};
  int described_ = 0;
};

TEST_F(TrackViewsTest, are_taken_in_turn_until_there_are_enough_then_once_a_second) {
  look(10, 400, 0, 1);
  EXPECT_EQ(described_, 10);
  EXPECT_EQ(views_.views(1).size(), TrackViews::kViews);
  EXPECT_EQ(views_.views(2).size(), TrackViews::kViews);
  look(100, 400, 0, 1);  // 5 s
  EXPECT_NEAR(described_, 10 + 10, 2);
  EXPECT_FLOAT_EQ((*views_.embedding(2))[0], 1);
}

TEST_F(TrackViewsTest, few_are_not_sure) {
  look(4, 400, 0, 1);
  EXPECT_FALSE(views_.embedding(1));
  look(2, 400, 0, 1);
  EXPECT_TRUE(views_.embedding(1));
  EXPECT_FALSE(views_.embedding(7));
  EXPECT_TRUE(views_.views(7).empty());
}

TEST_F(TrackViewsTest, may_become_sure_unless_they_may_be_anothers) {
  EXPECT_TRUE(views_.may_become_sure(1)) << "no view yet";
  const auto begin_again = [this] {
    views_ = {};
    look(2, 400, 0, 1);
    ASSERT_TRUE(views_.may_become_sure(1) && views_.may_become_sure(2));
  };
  begin_again();
  look(1, 120, 0, 1);
  EXPECT_FALSE(views_.may_become_sure(1) || views_.may_become_sure(2)) << "they were close";
  begin_again();
  look(2, 400, 1, 0);
  EXPECT_FALSE(views_.may_become_sure(1) || views_.may_become_sure(2)) << "another person's view";
  begin_again();
  for (int i = 0; i < 8; ++i) {  // in images so rare that the faces may have met in between
    now_ += 400ms;
    look(1, 400, 0, 1);
  }
  EXPECT_FALSE(views_.embedding(1) || views_.embedding(2));
  EXPECT_TRUE(views_.may_become_sure(1) && views_.may_become_sure(2));
  look(4, 400, 0, 1);
  EXPECT_TRUE(views_.embedding(1) && views_.embedding(2)) << "images are no longer rare";
}

TEST_F(TrackViewsTest, faces_that_were_close_are_looked_at_again) {
  look(20, 400, 0, 1);
  look(5, 120, 0, 1);
  EXPECT_FALSE(views_.embedding(1) || views_.embedding(2)) << "they may change places now";
  look(1, 400, 0, 1);
  EXPECT_FALSE(views_.embedding(1) && views_.embedding(2)) << "one has been described since";
  look(1, 400, 0, 1);
  EXPECT_TRUE(views_.embedding(1) && views_.embedding(2));
}

TEST_F(TrackViewsTest, tracks_that_changed_places_are_nobodys_until_they_are_sure) {
  look(20, 400, 0, 1);
  look(1, 120, 0, 1);
  for (int i = 0; i < 20; ++i) {
    look(1, 400, 1, 0);
    for (const int number : {1, 2}) {
      const auto embedding = views_.embedding(number);
      EXPECT_FLOAT_EQ(embedding ? (*embedding)[0] : 0, embedding && number == 1 ? 1 : 0) << i;
    }
  }
  EXPECT_TRUE(views_.embedding(1) && views_.embedding(2));
}

TEST_F(TrackViewsTest, a_face_before_a_hidden_one_may_be_either_until_it_is_looked_at) {
  look(20, 400, 0, 1);
  const std::vector<Track> seen{track(1, 100)};
  const auto all = expected({track(1, 100), track(2, 110)});
  static_cast<void>(views_.due(now_ += 50ms, seen, all));
  EXPECT_FALSE(views_.embedding(1));
  look(2, 400, 0.5, 1);
  EXPECT_FALSE(views_.embedding(1)) << "half a person's distance is too much";
}

TEST_F(TrackViewsTest, one_view_apart_changes_nothing_and_two_begin_again) {
  look(20, 400, 0, 1);
  views_.add(1, now_, view(0.9F));
  EXPECT_FLOAT_EQ(views_.embedding(1).value()[0], 0);
  views_.add(1, now_, view(0));
  views_.add(1, now_, view(0.9F));
  EXPECT_FLOAT_EQ(views_.embedding(1).value()[0], 0);
  views_.add(1, now_, view(0.9F));
  EXPECT_FALSE(views_.embedding(1));
}

TEST_F(TrackViewsTest, a_track_that_was_lost_may_be_another_persons) {
  look(20, 400, 0, 1);
  const auto hidden = expected({track(1, 100)});
  for (int i = 0; i < 2; ++i) static_cast<void>(views_.due(now_ += 200ms, {}, hidden));
  const std::vector<Track> seen{track(1, 100)};
  EXPECT_TRUE(views_.due(now_, seen, expected(seen)));
  EXPECT_FALSE(views_.embedding(1));
}

TEST_F(TrackViewsTest,
       where_images_are_rare_a_face_that_another_may_have_passed_is_looked_at_again) {
  for (const bool is_near : {false, true}) {
    views_ = {};
    look(20, 900, 0, 1);
    now_ += 400ms;
    look(1, is_near ? 400 : 900, 0, 1);
    EXPECT_EQ(views_.embedding(1).has_value(), !is_near);
  }
}

TEST_F(TrackViewsTest, end_with_their_track) {
  look(20, 400, 0, 1);
  now_ += 2s;
  EXPECT_FALSE(views_.due(now_, {}, {}));
  EXPECT_TRUE(views_.views(1).empty());
}

}  // namespace
