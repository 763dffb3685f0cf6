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

TEST(TruthRows, of_a_hand_are_put_together) {
  const auto hands = true_hands(Rows{{joint(1, kLeft, 0, 1), joint(1, kLeft, 20, 2),
                                      joint(1, kRight, 3, 3), joint(2, kRight, 3, 4)}});
  ASSERT_EQ(hands.size(), 3U);
  EXPECT_EQ(hands[0].joints[20].x(), 2);
  EXPECT_EQ(hands[0].pixels[0].x(), 10);
  EXPECT_EQ(hands[1].side, kRight);
  EXPECT_EQ(hands[2].person, 2);
  EXPECT_EQ(hands[2].joints[3].x(), 4);
}

TEST(TruthRows, that_no_joint_has_are_left_out) {
  auto high = joint(1, kLeft, 20, 1), nan = joint(1, kLeft, 0, 1);
  high[2] = 21;
  nan[3] = std::nan("");
  EXPECT_TRUE(true_hands(Rows{{high, nan, {}}}).empty());
}

}  // namespace
}  // namespace hc::room
