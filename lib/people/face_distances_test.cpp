// SPDX-License-Identifier: Apache-2.0
#include <people/face_distances.h>

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;
using hc::people::Face;

const hc::people::FacePair kPair{600, 0.1F};

/// A face of 15 cm at a distance, as an eye sees it that is displaced to the right by `shift`. [m]
Face face_away(float distance, float shift = 0, float down = 0) {
  const float width = 600 * 0.15F / distance, left = 400 - 600 * shift / distance;
  Face made;
  made.box = {left - width / 2, 300 - width / 2 + down, width, width};
  for (std::size_t i = 0; i < Face::kPoints; ++i)
    made.points.at(i) = {left + width * (static_cast<float>(i) - 2.5F) / 6, 300 + down};
  return made;
}

TEST(FaceDistance, is_triangulated) {
  for (const float distance : {0.5F, 1.F, 3.F}) {
    const auto found =
        hc::people::distance_by_eyes(face_away(distance), {face_away(distance, 0.1F)}, kPair);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, distance, 1e-3);  // [m]
  }
}

TEST(FaceDistance, is_that_of_the_same_face) {
  const std::vector<Face> right = {face_away(2, 0.1F, 80), face_away(0.5F, 0.1F),
                                   face_away(2, 0.1F)};
  EXPECT_NEAR(*hc::people::distance_by_eyes(face_away(2), right, kPair), 2, 1e-3);
  EXPECT_FALSE(hc::people::distance_by_eyes(face_away(2), {}, kPair));
  EXPECT_FALSE(hc::people::distance_by_eyes(face_away(2), {face_away(2, 0.1F, 80)}, kPair))
      << "too low";
  EXPECT_FALSE(hc::people::distance_by_eyes(face_away(2), {face_away(0.5F, 0.1F)}, kPair))
      << "too large";
  EXPECT_FALSE(hc::people::distance_by_eyes(face_away(2), {face_away(2, -0.1F)}, kPair))
      << "diverging";
}

TEST(FaceDistance, by_size_is_where_the_other_eye_sees_it) {
  EXPECT_NEAR(hc::people::distance_by_size(face_away(1.5F), kPair), 1.5, 1e-3);
  const auto box = hc::people::expected_in_right(face_away(1.5F), kPair);
  EXPECT_NEAR(box.x, face_away(1.5F, 0.1F).box.x, 0.1);  // [px]
  EXPECT_GT(hc::people::distance_by_size(Face(), kPair), 0) << "a face without a size";
}

TEST(FaceDistances, are_smoothed_and_kept_for_a_second) {
  hc::people::FaceDistances distances;
  hc::Time now(1'700'000'000s);
  EXPECT_FALSE(distances.find(1, now));
  distances.add(1, now, 2);
  EXPECT_FLOAT_EQ(*distances.find(1, now), 2);
  distances.add(1, now + 50ms, 3);
  EXPECT_NEAR(*distances.find(1, now + 50ms), 2.22, 0.01);
  for (int i = 2; i < 40; ++i) distances.add(1, now + i * 50ms, 3);
  EXPECT_NEAR(*distances.find(1, now + 2s), 3, 0.01);
  EXPECT_FALSE(distances.find(2, now + 2s));
  EXPECT_FALSE(distances.find(1, now + 4s));
}

TEST(FaceDistances, are_due_in_turn) {
  hc::people::FaceDistances distances;
  const hc::Time now(1'700'000'000s);
  const auto tracks = [](int count) {
    std::vector<hc::people::Track> made(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) made[static_cast<std::size_t>(i)].number = i + 1;
    return made;
  };
  using Places = std::vector<std::size_t>;
  EXPECT_EQ(distances.due(now, {}), Places());
  EXPECT_EQ(distances.due(now, tracks(3)), Places{0});
  EXPECT_EQ(distances.due(now + 50ms, tracks(3)), Places{1});
  EXPECT_EQ(distances.due(now + 100ms, tracks(3)), Places{2});
  EXPECT_EQ(distances.due(now + 150ms, tracks(3)), Places()) << "each was within 0.2 s";
  EXPECT_EQ(distances.due(now + 300ms, tracks(3)), Places{0}) << "longest ago";
  EXPECT_EQ(distances.due(now + 350ms, tracks(8)), (Places{3, 4})) << "a quarter, new ones first";
  EXPECT_EQ(distances.due(now - 10s, tracks(1)), Places{0}) << "time went back";
}

}  // namespace
