// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <hc/base/format.h>

namespace hc {
namespace {

TEST(Format, PutsValuesInTheirOrder) {
  EXPECT_EQ(format("no value"), "no value");
  EXPECT_EQ(format("{} of {}: {}", 3, std::size_t{4}, std::string("ok")), "3 of 4: ok");
  EXPECT_EQ(format("{} {}", INT64_MIN, UINT64_MAX), "-9223372036854775808 18446744073709551615");
  EXPECT_EQ(format("{{{}}}", "x"), "{x}");
}

TEST(Format, PadsTextToTheRightAndNumbersToTheLeft) {
  EXPECT_EQ(format("[{:4}] [{:4}] [{:<4}] [{:>4}]", "ab", 12, 12, "ab"),
            "[ab  ] [  12] [12  ] [  ab]");
  EXPECT_EQ(format("[{:<{}}] [{:.{}f}]", "ab", 3, 0.5, 2), "[ab ] [0.50]");
  EXPECT_EQ(format("[{:<5}]", "a→b"), "[a→b  ]") << "as wide as it has code points";
  EXPECT_EQ(format("[{:1}]", "abc"), "[abc]");
}

TEST(Format, WritesNumbersAsAsked) {
  EXPECT_EQ(format("{:02} {:02x} {:.3f} {:3.0f} {:.3g} {:g} {:9.4f}", 7, 10u, 1.0 / 3, 5.0,
                   1234567.0, 0.25, -1.5),
            "07 0a 0.333   5 1.23e+06 0.25   -1.5000");
  EXPECT_EQ(format("{} {}", 0.1, 1e300 * 10), "0.1 1e+301");
  EXPECT_EQ(format("{:.1f}", std::nan("")), "nan");
  EXPECT_EQ(format("{:.0f}", 1e308).size(), 309u);
}

TEST(FormatDeathTest, APatternThatDoesNotFitIsABug) {
  EXPECT_DEATH(format("{} {}", 1), "check");
  EXPECT_DEATH(format("{}", 1, 2), "check");
  EXPECT_DEATH(format("}"), "check");
}

TEST(Format, HexadecimalDigitsOfBytes) {
  EXPECT_EQ(hexadecimal(std::array<unsigned char, 3>{0x00, 0x9a, 0xff}), "009aff");
  EXPECT_EQ(hexadecimal({}), "");
}

}  // namespace
}  // namespace hc
