// SPDX-License-Identifier: Apache-2.0
#include <hc/base/natural_order.h>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace hc {
namespace {

using Names = std::vector<std::string>;

TEST(NaturalOrder, numbers_are_compared_as_numbers) {
  // Of a007 and a7, and of a10a and a0010b, the numbers are equal.
  const Names sorted{"",        "1",       "1.png",  "1_2.png", "1_10.png", "2.png", "10.png", "a",
                     "a1b10c2", "a1b10c3", "a2b1c1", "a007",    "a7",       "a10a",  "a0010b"};
  Names shuffled = sorted;
  std::ranges::reverse(shuffled);
  std::ranges::sort(shuffled, natural_less);
  EXPECT_EQ(shuffled, sorted);
}

TEST(NaturalOrder, numbers_of_any_length) {
  const std::string huge(40, '9');
  EXPECT_TRUE(natural_less(huge, "1" + std::string(40, '0')));
  EXPECT_FALSE(natural_less("1" + std::string(40, '0'), huge));
  EXPECT_TRUE(natural_less("frame_1403636579763555584.png", "frame_1403636580013555456.png"));
}

TEST(NaturalOrder, is_a_strict_order) {
  const Names names{"", "0", "00", "1", "01", "1a", "01a", "a", "a0", "a00", "\xff", "1\xff"};
  for (const auto& a : names) {
    EXPECT_FALSE(natural_less(a, a));
    for (const auto& b : names) {
      EXPECT_EQ(natural_less(a, b), a != b && !natural_less(b, a)) << a << " and " << b;
      for (const auto& c : names) {
        const bool follows = natural_less(a, b) && natural_less(b, c);
        EXPECT_TRUE(!follows || natural_less(a, c)) << a << ", " << b << ", " << c;
      }
    }
  }
}

}  // namespace
}  // namespace hc
