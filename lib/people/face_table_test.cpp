// SPDX-License-Identifier: Apache-2.0
#include <people/face_table.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace hc::people {
namespace {

FaceRow some_face() {
  FaceRow row{{{10, 20, 30, 40}, 0.75F, {}}, 7, 2, {1.5, -0.25, 0.125}};
  for (std::size_t i = 0; i < row.face.points.size(); ++i)
    row.face.points[i] = {10 + 2 * static_cast<float>(i), 20 + 3 * static_cast<float>(i)};
  return row;
}

std::vector<double> written(const FaceRow& face) {
  std::vector<double> row(kFaceColumns);
  write(face, row);
  return row;
}

TEST(FaceTable, has_the_columns_that_are_published) {
  const auto columns = face_columns();
  ASSERT_EQ(columns.size(), static_cast<std::size_t>(kFaceColumns));
  const auto row = written(some_face());
  const auto is = [&](std::size_t column, const char* name, double number) {
    EXPECT_EQ(columns[column], name);
    EXPECT_NEAR(row[column], number, 1e-9) << name;
  };
  is(2, "width [px]", 30);
  is(4, "score", 0.75);
  is(5, "track", 7);
  is(6, "person", 2);
  is(7, "right eye x [px]", 10);
  is(10, "left eye y [px]", 23);
  is(18, "left ear y [px]", 35);
  is(19, "roll [rad]", std::round(std::atan2(3, 2) * 1e4) / 1e4);
  is(21, "x [m]", 1.5);
  is(23, "z [m]", 0.125);
}

TEST(FaceTable, is_read_as_it_was_written) {
  const auto row = written(some_face());
  const auto face = face_in(row);
  ASSERT_TRUE(face);
  EXPECT_EQ(written(*face), row);
}

TEST(FaceTable, heads_are_neither_in_the_camera_nor_out_of_sight) {
  EXPECT_TRUE(can_be_face({1, 0, 0}));
  EXPECT_TRUE(can_be_face({-60, 60, 0}));
  EXPECT_FALSE(can_be_face({0, 0, 0}));
  EXPECT_FALSE(can_be_face({0, 100.5, 0}));
}

TEST(FaceTable, rows_that_are_no_faces_are_none) {
  auto row = written(some_face());
  EXPECT_FALSE(face_in(std::span(row).first(row.size() - 1)));
  EXPECT_FALSE(face_in({}));
  for (auto& number : row)
    for (const double wrong : {double(NAN), double(INFINITY), -1e300}) {
      const double right = std::exchange(number, wrong);
      EXPECT_FALSE(face_in(row)) << wrong << " in column " << &number - row.data();
      number = right;
    }
  for (const auto& [column, wrong] :
       {std::pair(5, 0.0), {5, 2.5}, {5, -1.0}, {6, -1.0}, {6, 0.5}}) {
    auto other = row;
    other[static_cast<std::size_t>(column)] = wrong;
    EXPECT_FALSE(face_in(other)) << wrong << " in column " << column;
  }
}

}  // namespace
}  // namespace hc::people
