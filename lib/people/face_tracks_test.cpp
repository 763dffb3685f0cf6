// SPDX-License-Identifier: Apache-2.0
#include <people/face_tracks.h>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace std::chrono_literals;
using hc::people::Face;
using hc::people::FaceTracks;

constexpr hc::Time kFirst(1'700'000'000s);
constexpr auto kPeriod = 50ms;

Face face_at(float x, float width = 60) {
  Face made;
  made.box = {x, 100, width, width};
  return made;
}

class FaceTracksTest : public testing::Test {
 protected:
  /// The numbers of the tracks of faces in the next image.
  std::vector<int> look(const std::vector<Face>& faces, bool may_be_new = true) {
    now_ += kPeriod;
    std::vector<FaceTracks::Sighting> sightings;
    for (const Face& face : faces) sightings.push_back({face, may_be_new});
    std::vector<int> numbers;
    for (const auto& track : tracks_.update(now_, sightings)) numbers.push_back(track.number);
    return numbers;
  }
  FaceTracks tracks_;
  hc::Time now_ = kFirst;
};

TEST_F(FaceTracksTest, number_faces_in_the_order_of_the_image) {
  EXPECT_EQ(look({face_at(100), face_at(300)}), (std::vector<int>{1, 2}));
  EXPECT_EQ(look({face_at(302), face_at(101), face_at(500)}), (std::vector<int>{2, 1, 3}));
  EXPECT_TRUE(look({}).empty());
}

TEST_F(FaceTracksTest, begin_with_a_face_that_may_be_new_and_go_on_with_any) {
  EXPECT_TRUE(look({face_at(100)}, false).empty());
  EXPECT_TRUE(tracks_.expected(now_).empty());
  EXPECT_EQ(look({face_at(100)}), std::vector<int>{1});
  EXPECT_EQ(look({face_at(400), face_at(102)}, false), std::vector<int>{1});
}

TEST_F(FaceTracksTest, follow_a_face_that_moves_by_its_width_in_three_images) {
  for (float x = 0; x < 700; x += 20) EXPECT_EQ(look({face_at(x)}), std::vector<int>{1}) << x;
}

TEST_F(FaceTracksTest, go_on_behind_what_hides_the_face_for_less_than_a_second) {
  for (int i = 0; i < 20; ++i) look({face_at(100 + 10 * static_cast<float>(i))});
  for (int i = 20; i < 35; ++i) look({});
  EXPECT_EQ(look({face_at(100 + 10 * 35)}), std::vector<int>{1}) << "it has moved on";
  now_ += 1s;
  for (int i = 0; i < FaceTracks::kMisses; ++i) look({});
  EXPECT_EQ(look({face_at(460)}), std::vector<int>{2});
}

TEST_F(FaceTracksTest, go_on_where_images_are_rare) {
  for (int i = 0; i < 5; ++i) {
    now_ += 1500ms;
    EXPECT_EQ(look({face_at(100)}), std::vector<int>{1}) << i;
  }
  now_ += 5s;
  EXPECT_EQ(look({face_at(100)}), std::vector<int>{2});
}

TEST_F(FaceTracksTest, are_expected_where_the_face_will_be) {
  for (int i = 0; i < 20; ++i) look({face_at(100 + 10 * static_cast<float>(i))});
  const auto expected = tracks_.expected(now_ + 4 * kPeriod);
  ASSERT_EQ(expected.size(), 1U);
  EXPECT_NEAR(expected[0].box.x, 100 + 10 * 23, 5);  // [px]
  EXPECT_NEAR(expected[0].box.width, 60, 2);
}

TEST_F(FaceTracksTest, stay_when_the_camera_turns) {
  for (int i = 0; i < 10; ++i) look({face_at(100 + 5 * static_cast<float>(i))});
  const cv::Matx33f turn(1, 0, -200, 0, 1, 0, 0, 0, 1);
  tracks_.turn(turn);
  EXPECT_EQ(look({face_at(150 - 200)}), std::vector<int>{1});
  EXPECT_NEAR(tracks_.expected(now_ + kPeriod)[0].box.x, 155 - 200, 2) << "its own motion goes on";
  tracks_.turn(cv::Matx33f::zeros());
  EXPECT_EQ(tracks_.expected(now_).size(), 1U) << "behind the camera";
}

TEST_F(FaceTracksTest, two_that_cross_stay_apart) {
  for (float x = 0; x <= 600; x += 10) {
    const std::vector<Face> both = {face_at(x), face_at(600 - x, 66)};
    EXPECT_EQ(look(both), (std::vector<int>{1, 2})) << x;
  }
}

TEST_F(FaceTracksTest, one_who_passes_behind_another_leaves_the_track_there) {
  for (float x = 0; x <= 600; x += 10) {
    const bool is_hidden = std::abs(x - 300) < 50;
    const Face before = face_at(296, 60);
    const auto numbers =
        look(is_hidden ? std::vector<Face>{before} : std::vector<Face>{before, face_at(x, 45)});
    EXPECT_EQ(numbers, is_hidden ? std::vector<int>{1} : (std::vector<int>{1, 2})) << x;
  }
}

TEST_F(FaceTracksTest, follow_a_face_that_sets_off_between_rare_images) {
  for (int i = 0; i < 10; ++i) look({face_at(400)});
  now_ += 300ms;
  EXPECT_EQ(look({face_at(450)}), std::vector<int>{1}) << "1 m/s at 2 m";
  EXPECT_EQ(look({face_at(600)}), std::vector<int>{2}) << "too fast for a person";
}

TEST_F(FaceTracksTest, a_stranger_far_from_a_lost_face_is_new) {
  for (int i = 0; i < 20; ++i) look({face_at(100)});
  now_ += 850ms;
  EXPECT_EQ(look({face_at(500)}), std::vector<int>{2});
}

TEST_F(FaceTracksTest, of_two_at_one_place_the_one_of_its_width_takes_a_face) {
  for (int i = 0; i < 5; ++i) look({face_at(100, 100), face_at(400, 50)});
  for (int i = 0; i < 25; ++i)
    look({face_at(100 + 10 * static_cast<float>(i), 100), face_at(400, 50)});
  now_ += 250ms;
  EXPECT_EQ(look({face_at(400, 50)}), std::vector<int>{2});
}

TEST_F(FaceTracksTest, are_new_when_the_clock_is_set) {
  look({face_at(100)});
  now_ -= 1h;
  EXPECT_EQ(look({face_at(100)}), std::vector<int>{2});
  now_ -= 2s;
  EXPECT_EQ(look({face_at(100)}), std::vector<int>{3});
  now_ -= 20 * kPeriod;
  EXPECT_EQ(look({face_at(100)}), std::vector<int>{3}) << "a little: an image that came late";
}

TEST_F(FaceTracksTest, are_expected_no_longer_after_a_pause_of_images) {
  for (int i = 0; i < 20; ++i) look({face_at(100, 60 + 20 * static_cast<float>(i))});
  EXPECT_TRUE(tracks_.expected(now_ + 1h).empty()) << "not as a face of a million pixels";
}

TEST_F(FaceTracksTest, boxes_without_a_size_harm_nobody) {
  for (int i = 0; i < 3; ++i) look({face_at(100, 0), face_at(200)});
  EXPECT_EQ(tracks_.expected(now_).size(), 2U);
}

}  // namespace
