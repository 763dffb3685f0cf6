// SPDX-License-Identifier: Apache-2.0
#include <people/hand_table.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include <people/made_hand_test.h>

namespace hc::people {
namespace {

HandRow some_hand() {
  return {3, Hand::Side::Left, 0.75F, Sign::Victory, made_hand({}).points};
}

std::vector<double> written(const HandRow& hand) {
  std::vector<double> row(kHandColumns);
  write(hand, row);
  return row;
}

TEST(HandTable, has_the_columns_that_are_published) {
  const auto columns = hand_columns();
  ASSERT_EQ(columns.size(), 46U);
  const HandRow hand = some_hand();
  const auto row = written(hand);
  const auto is = [&](std::size_t column, const char* name, double number) {
    EXPECT_EQ(columns[column], name);
    EXPECT_NEAR(row[column], number, 0.005) << name;
  };
  is(0, "track", 3);
  is(1, "side", 0);
  is(2, "presence", 0.75);
  is(3, "sign", 4);
  is(4, "wrist x [px]", hand.points[Hand::Wrist].x);
  is(13, "thumb tip y [px]", hand.points[Hand::ThumbTip].y);
  is(20, "index tip x [px]", hand.points[Hand::IndexTip].x);
  is(45, "little tip y [px]", hand.points[Hand::LittleTip].y);
}

TEST(HandTable, is_read_as_it_was_written) {
  const auto row = written(some_hand());
  const auto hand = hand_in(row);
  ASSERT_TRUE(hand);
  EXPECT_EQ(written(*hand), row);
}

TEST(HandTable, rows_that_are_no_hands_are_none) {
  auto row = written(some_hand());
  EXPECT_FALSE(hand_in(std::span(row).first(row.size() - 1)));
  for (auto& number : row)
    for (const double wrong : {double(NAN), double(INFINITY), -1e300}) {
      const double right = std::exchange(number, wrong);
      EXPECT_FALSE(hand_in(row)) << wrong << " in column " << &number - row.data();
      number = right;
    }
  for (const auto& [column, wrong] : {std::pair(0, 0.0),
                                      {0, 1.5},
                                      {1, 2.0},
                                      {1, 0.5},
                                      {2, 1.5},
                                      {2, -0.5},
                                      {3, 6.0},
                                      {3, -1.0},
                                      {3, 0.5}}) {
    auto other = row;
    other[static_cast<std::size_t>(column)] = wrong;
    EXPECT_FALSE(hand_in(other)) << wrong << " in column " << column;
  }
}

}  // namespace
}  // namespace hc::people
