// SPDX-License-Identifier: Apache-2.0
#include "seen_faces.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

constexpr hc::Time kSeen{100s};
const hc::vision::Pinhole kEye{600, 600, 399.5, 299.5};

/// A row of the table whose eyes are around a pixel.
std::vector<double> row(double x, double y, const std::vector<double>& place) {
  std::vector<double> row(21);
  row[7] = x - 20;
  row[9] = x + 20;
  row[8] = row[10] = y;
  row.insert(row.end(), place.begin(), place.end());
  return row;
}

std::optional<Vector3d> eyes_of(const std::vector<double>& table, std::size_t rows,
                                const Vector3d& tip, hc::Time time = kSeen) {
  SeenFaces faces;
  EXPECT_TRUE(faces.take(kSeen, {table.data(), rows, table.size() / rows, 1}));
  Eigen::Isometry3d T_head_camera = Eigen::Isometry3d::Identity();
  T_head_camera.translation() = Vector3d(0.06, 0.05, 0.05);
  return faces.eyes_near(time, tip, kEye, T_head_camera);
}

TEST(SeenFaces, say_where_the_eyes_are_in_the_heads_frame) {
  const auto eyes = eyes_of(row(0, 0, {0.26, 0.15, 1.55}), 1, {0.3, 0.3, 1});
  ASSERT_TRUE(eyes);
  EXPECT_TRUE(eyes->isApprox(Vector3d(0.2, 0.1, 1.5)));
}

TEST(SeenFaces, say_where_the_eyes_are_by_pixel_and_distance) {
  const auto eyes = eyes_of(row(399.5 + 300, 299.5, {std::sqrt(1.25)}), 1, {0.3, 0, 0.9});
  ASSERT_TRUE(eyes);
  EXPECT_TRUE(eyes->isApprox(Vector3d(0.5, 0, 1)));
}

TEST(SeenFaces, are_of_the_nearest_person) {
  auto table = row(399.5, 299.5, {1.5});
  const auto other = row(399.5 + 300, 299.5, {1.5});
  table.insert(table.end(), other.begin(), other.end());
  EXPECT_NEAR(eyes_of(table, 2, {0.1, 0, 1})->x(), 0, 1e-9);
  EXPECT_GT(eyes_of(table, 2, {0.6, 0, 1})->x(), 0.5);
}

TEST(SeenFaces, far_away_or_long_ago_are_none) {
  const auto table = row(399.5, 299.5, {3.0});
  EXPECT_FALSE(eyes_of(table, 1, {0, 0, 1})) << "another person's";
  EXPECT_TRUE(eyes_of(table, 1, {0, 0, 2.2}));
  EXPECT_FALSE(eyes_of(table, 1, {0, 0, 2.2}, kSeen + 501ms));
  EXPECT_FALSE(eyes_of(row(399.5, 299.5, {0.0}), 1, {0, 0, 0.5})) << "unknown distance";
  SeenFaces none;
  EXPECT_FALSE(none.eyes_near(kSeen, {0, 0, 1}, kEye, Eigen::Isometry3d::Identity()));
}

TEST(SeenFaces, of_another_table_are_refused) {
  SeenFaces faces;
  const std::vector<double> numbers(12);
  const auto taken = faces.take(kSeen, {numbers.data(), 1, 12, 1});
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().text(), "Unsupported: a table of 12 columns is none of faces");
  EXPECT_TRUE(faces.take(kSeen, {numbers.data(), 0, 0, 1})) << "nobody is seen";
}

}  // namespace
