// SPDX-License-Identifier: Apache-2.0
#include "named_faces.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <hc/base/format.h>
#include <people/face_table.h>

namespace {

using namespace std::chrono_literals;
using Eigen::Vector3d;

constexpr hc::Time kLooked{100s};

/// A row of the table of faces.
std::vector<double> face_row(double person, const Vector3d& p_head) {
  std::vector<double> row(hc::people::kFaceColumns);
  hc::people::write({.track = 1}, row);
  row[6] = person;
  for (int axis = 0; axis < 3; ++axis) row[21 + static_cast<std::size_t>(axis)] = p_head[axis];
  return row;
}

std::vector<NamedFaces::Face> faces_in(const std::vector<std::vector<double>>& rows) {
  std::vector<double> numbers;
  for (const auto& each : rows) numbers.insert(numbers.end(), each.begin(), each.end());
  return NamedFaces::read({numbers.data(), rows.size(), hc::people::kFaceColumns, 1});
}

/// The name that is shown of a person.
std::string name_shown(const std::string& lines, int person = 1) {
  NamedFaces faces;
  EXPECT_TRUE(faces.name(lines));
  faces.see(kLooked, {{person, {1, 0, 0}}}, Eigen::Isometry3d::Identity());
  const auto found = faces.at(kLooked);
  return found.empty() ? "" : found.front().name;
}

TEST(NamedFaces, are_where_the_head_was_when_it_saw_them) {
  NamedFaces faces;
  ASSERT_TRUE(faces.name("1 Anna\n7 Ben Ode"));
  faces.see(kLooked, faces_in({face_row(7, {1.5, 0.2, 0.1}), face_row(1, {3, 0, 0})}),
            Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1.2)));
  const auto found = faces.at(kLooked + 70ms);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].name, "Ben Ode");
  EXPECT_TRUE(found[0].p_world.isApprox(Vector3d(1.5, 0.2, 1.3)));
  EXPECT_EQ(found[1].name, "Anna");
}

TEST(NamedFaces, vanish_with_the_faces) {
  NamedFaces faces;
  ASSERT_TRUE(faces.name("1 Anna"));
  EXPECT_TRUE(faces.at(kLooked).empty());
  faces.see(kLooked, {{1, {1, 0, 0}}}, Eigen::Isometry3d::Identity());
  EXPECT_EQ(faces.at(kLooked + NamedFaces::kLife).size(), 1U);
  EXPECT_EQ(faces.at(kLooked - NamedFaces::kLife).size(), 1U) << "of an older image";
  EXPECT_TRUE(faces.at(kLooked + NamedFaces::kLife + 1ms).empty()) << "of images without a table";
  faces.see(kLooked + 100ms, faces_in({}), Eigen::Isometry3d::Identity());
  EXPECT_TRUE(faces.at(kLooked + 100ms).empty());
}

TEST(NamedFaces, are_of_persons_who_have_a_name) {
  NamedFaces faces;
  ASSERT_TRUE(faces.name("1 Anna"));
  faces.see(kLooked, {{2, {1, 0, 0}}}, Eigen::Isometry3d::Identity());
  EXPECT_TRUE(faces.at(kLooked).empty());
  ASSERT_TRUE(faces.name("2 Ben"));
  EXPECT_EQ(faces.at(kLooked).size(), 1U);
  ASSERT_TRUE(faces.name(""));
  EXPECT_TRUE(faces.at(kLooked).empty()) << "forgotten";
}

TEST(NamedFaces, that_cannot_be_are_ignored) {
  const double nan = std::nan(""), endless = std::numeric_limits<double>::infinity();
  const auto found =
      faces_in({face_row(0, {2, 0, 0}), face_row(-3, {2, 0, 0}), face_row(1e300, {2, 0, 0}),
                face_row(nan, {2, 0, 0}), face_row(1, {0, 0, 0}), face_row(1, {nan, 0, 0}),
                face_row(1, {1, 0, endless}), face_row(1, {1e6, 0, 0}), face_row(5, {2, 0, 0})});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].person, 5);
}

TEST(NamedFaces, are_the_nearest_with_a_name_of_too_many) {
  std::vector<std::vector<double>> rows;
  std::string names;
  for (int i = 100; i > 0; --i) {
    rows.push_back(face_row(i, {0.5 * i, 0, 0}));
    if (i > 20) names += hc::format("{} {}\n", i, i);
  }
  NamedFaces faces;
  ASSERT_TRUE(faces.name(names));
  faces.see(kLooked, faces_in(rows), Eigen::Isometry3d::Identity());
  const auto found = faces.at(kLooked);
  ASSERT_EQ(found.size(), NamedFaces::kMostFaces);
  EXPECT_EQ(found.front().name, "21");
  EXPECT_EQ(found.back().name, "36");
}

TEST(NamedFaces, have_names_that_can_be_shown) {
  EXPECT_EQ(name_shown("1 Zo\u00eb  Gr\u00fcn"), "Zo\u00eb  Gr\u00fcn");
  EXPECT_EQ(name_shown("1 Jos\xe9"), "Jos\\xe9");
  EXPECT_EQ(name_shown("1 a\x1b[2Jb"), "a\\x1b[2Jb");
  std::string just, more;
  for (std::size_t i = 0; i < NamedFaces::kMostLetters; ++i) just += "\u00fc";
  EXPECT_EQ(name_shown("1 " + just), just);
  EXPECT_EQ(name_shown("1 " + just + "x"), just + "...");
  std::string wide;
  for (std::size_t i = 0; i <= NamedFaces::kMostLetters; ++i) wide += "\U0001F600";
  EXPECT_TRUE(name_shown("1 " + wide).ends_with("..."));
  EXPECT_EQ(name_shown("1 " + std::string(1 << 20, 'a')),
            std::string(NamedFaces::kMostLetters, 'a') + "...");
}

TEST(NamedFaces, are_named_although_other_lines_are_wrong) {
  for (const std::string wrong :
       {"x Ben", "2", "2 ", "", "-2 Ben", "0 Ben", "99999999999 Ben", "2.5 Ben", " 2 Ben"}) {
    NamedFaces faces;
    const auto named = faces.name(wrong + "\n1 Anna");
    ASSERT_FALSE(named) << wrong;
    EXPECT_EQ(named.error().text(), "Malformed: \"" + wrong + "\" is not PERSON NAME");
    faces.see(kLooked, {{1, {1, 0, 0}}}, Eigen::Isometry3d::Identity());
    EXPECT_EQ(faces.at(kLooked).size(), 1U);
  }
}

TEST(NamedFaces, are_a_thousand_at_most) {
  std::string lines;
  for (int i = 1; i <= 1001; ++i) lines += std::to_string(i) + " Anna\n";
  NamedFaces faces;
  const auto named = faces.name(lines);
  ASSERT_FALSE(named);
  EXPECT_EQ(named.error().text(), "Malformed: there are more than 1000 names");
}

}  // namespace
