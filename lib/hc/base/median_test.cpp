// SPDX-License-Identifier: Apache-2.0
#include <hc/base/median.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Median, is_in_the_middle_of_the_sorted_numbers) {
  EXPECT_EQ(median<int>({3}), 3);
  EXPECT_EQ(median<int>({9, 1, 5}), 5);
  EXPECT_EQ(median<double>({4, 1, 3, 2}), 3) << "the upper of both";
}

}  // namespace
}  // namespace hc
