// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/rows.h>

#include <gtest/gtest.h>

#include <hc/mtp/codec.h>

namespace hc {
namespace {

using Lines = std::vector<std::string>;

TEST(Rows, ComeBackAsTheyWent) {
  for (const Lines& lines : {Lines{}, {"one"}, {"a", "", "  longer"}}) {
    EXPECT_EQ(rows_of(make_rows(lines)), lines);
  }
}

TEST(Rows, AreFilledUpWithSpaces) {
  const Lines lines = {"a", "bcd"};
  EXPECT_EQ(encode(make_rows(lines)), "1 0 0 0 8 0 60101 0 0 3 2\na  bcd\n");
}

TEST(Rows, WhatIsNoStringHasNone) {
  EXPECT_TRUE(
      rows_of(Draft::make({MatrixType::Table, 1, Scalar::U8, Encoding::Binary}, 1, 2).finish())
          .empty());
  EXPECT_TRUE(rows_of(make_rows(Lines{"", ""})).empty());
}

}  // namespace
}  // namespace hc
