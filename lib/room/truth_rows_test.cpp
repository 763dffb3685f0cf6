// SPDX-License-Identifier: Apache-2.0
#include <room/truth_rows.h>

#include <gtest/gtest.h>

#include <cmath>

namespace hc::room {
namespace {

/// A table in memory, as a view of a message.
struct Rows {
  std::vector<std::vector<double>> all;
  [[nodiscard]] std::size_t height() const { return all.size(); }
  [[nodiscard]] std::span<const double> row(std::size_t i) const { return all[i]; }
};

std::vector<double> joint(int person, int side, int joint, double x) {
  std::vector<double> row(kJointColumns);
  write_row<JointColumns>(JointRow{person, side, joint, {x, 0, 1}, {10 * x, 5}}, row);
  return row;
}

TEST(TruthRows, have_as_many_columns_as_they_say) {
  EXPECT_EQ((column_names<PersonColumns, PersonRow>().size()), std::size_t{kPersonColumns});
  EXPECT_EQ((column_names<JointColumns, JointRow>().size()), std::size_t{kJointColumns});
  EXPECT_EQ((column_names<PointedColumns, PointedRow>().size()), std::size_t{kPointedColumns});
}

/// All joints of a hand, the last one first.
std::vector<std::vector<double>> hand(int person, int side) {
  std::vector<std::vector<double>> rows;
  for (int i = kHandJoints - 1; i >= 0; --i) rows.push_back(joint(person, side, i, i));
  return rows;
}

TEST(TruthRows, of_a_hand_are_put_together) {
  Rows rows{hand(2, kRight)};
  const auto left = hand(1, kLeft);
  rows.all.insert(rows.all.begin() + 7, left.begin(), left.end());
  const auto hands = true_hands(rows);
  ASSERT_EQ(hands.size(), 2U);
  EXPECT_EQ(hands[0].person, 1);
  EXPECT_EQ(hands[1].side, kRight);
  EXPECT_EQ(hands[1].joints[20].x(), 20);
  EXPECT_EQ(hands[1].pixels[3].x(), 30);
}

TEST(TruthRows, that_are_invalid_are_skipped_and_a_hand_with_them) {
  for (const auto& [column, wrong] : {std::pair(2U, 21.0), {3U, std::nan("")}, {1U, 2.0}}) {
    Rows rows{hand(1, kLeft)};
    rows.all[4][column] = wrong;
    EXPECT_TRUE(true_hands(rows).empty()) << column;
  }
  EXPECT_TRUE(true_hands(Rows{{{}, {1, 2}}}).empty());
}

}  // namespace
}  // namespace hc::room
