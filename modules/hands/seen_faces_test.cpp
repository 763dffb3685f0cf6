// SPDX-License-Identifier: Apache-2.0
#include "seen_faces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include <people/face_table.h>

namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

constexpr hc::Time kSeen{100s};

/// Where a camera sees the eyes near a finger tip, of faces in these places of the head's frame.
std::optional<Vector3d> eyes_of(const std::vector<Vector3d>& places, const Vector3d& tip,
                                hc::Time time = kSeen) {
  constexpr std::size_t kWidth = hc::people::kFaceColumns;
  std::vector<double> table(places.size() * kWidth);
  for (std::size_t i = 0; i < places.size(); ++i)
    write(hc::people::FaceRow{{{10, 10, 20, 20}, 1, {}}, static_cast<int>(i) + 1, 0, places[i]},
          std::span(table).subspan(i * kWidth, kWidth));
  SeenFaces faces;
  faces.take(kSeen, {table.data(), places.size(), kWidth, 1});
  Eigen::Isometry3d T_head_camera = Eigen::Isometry3d::Identity();
  T_head_camera.translation() = Vector3d(0.06, 0.05, 0.05);
  return faces.eyes_near(time, tip, T_head_camera);
}

TEST(SeenFaces, say_where_the_eyes_are_in_the_cameras_frame) {
  const auto eyes = eyes_of({{0.26, 0.15, 1.55}}, {0.3, 0.3, 1});
  ASSERT_TRUE(eyes);
  EXPECT_TRUE(eyes->isApprox(Vector3d(0.2, 0.1, 1.5)));
}

TEST(SeenFaces, are_in_view_for_a_while_after_they_were_seen) {
  std::vector<double> table(hc::people::kFaceColumns);
  write(hc::people::FaceRow{{{10, 20, 30, 40}, 1, {}}, 1, 0, {2, 0, 0}}, table);
  SeenFaces faces;
  EXPECT_TRUE(faces.boxes(kSeen).empty());
  faces.take(kSeen, {table.data(), 1, table.size(), 1});
  faces.take(kSeen + 100ms, {table.data(), 0, table.size(), 1});
  ASSERT_EQ(faces.boxes(kSeen + 2900ms).size(), 1U);
  EXPECT_EQ(faces.boxes(kSeen)[0], cv::Rect2f(10, 20, 30, 40));
  EXPECT_TRUE(faces.boxes(kSeen + 3s).empty());
}

TEST(SeenFaces, are_not_kept_without_end) {
  std::vector<double> table(1000 * hc::people::kFaceColumns);
  for (std::size_t i = 0; i < 1000; ++i)
    write(hc::people::FaceRow{{{10, 20, 30, 40}, 1, {}}, static_cast<int>(i) + 1, 0, {2, 0, 0}},
          std::span(table).subspan(i * hc::people::kFaceColumns, hc::people::kFaceColumns));
  SeenFaces faces;
  faces.take(kSeen, {table.data(), 1000, hc::people::kFaceColumns, 1});
  EXPECT_EQ(faces.boxes(kSeen).size(), SeenFaces::kMost);
}

TEST(SeenFaces, are_of_the_nearest_person) {
  const std::vector<Vector3d> places = {{0.06, 0.05, 1.55}, {0.76, 0.05, 1.4}};
  EXPECT_NEAR(eyes_of(places, {0.1, 0, 1})->x(), 0, 1e-9);
  EXPECT_GT(eyes_of(places, {0.6, 0, 1})->x(), 0.5);
}

TEST(SeenFaces, far_away_or_long_ago_are_none) {
  const std::vector<Vector3d> places = {{0, 0, 3}};
  EXPECT_FALSE(eyes_of(places, {0, 0, 1})) << "another person's";
  EXPECT_TRUE(eyes_of(places, {0, 0, 2.2}));
  EXPECT_FALSE(eyes_of(places, {0, 0, 2.2}, kSeen + 501ms));
  EXPECT_FALSE(eyes_of({{0, 0, -0.3}}, {0, 0, 0.3})) << "behind the camera";
  EXPECT_FALSE(eyes_of({{0, 0, NAN}}, {0, 0, 0.5}));
  EXPECT_FALSE(eyes_of({}, {0, 0, 1}));
}

}  // namespace
