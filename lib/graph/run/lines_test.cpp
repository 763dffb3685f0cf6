// SPDX-License-Identifier: Apache-2.0
#include <graph/run/lines.h>

#include <gtest/gtest.h>

#include <vector>

namespace hc::internal {
namespace {

class LinesTest : public ::testing::Test {
 protected:
  void add(std::string_view piece) {
    lines_.add(piece, [&](const std::string& line) { heard_.push_back(line); });
  }
  void finish() {
    lines_.finish([&](const std::string& line) { heard_.push_back(line); });
  }

  Lines lines_;
  std::vector<std::string> heard_;
};

TEST_F(LinesTest, ComeWholeAndNotEmpty) {
  add("one\n\ntw");
  add("o\nthree");
  EXPECT_EQ(heard_, (std::vector<std::string>{"one", "two"}));
  finish();
  finish();
  EXPECT_EQ(heard_, (std::vector<std::string>{"one", "two", "three"}));
}

TEST_F(LinesTest, LongOnesComeInParts) {
  add(std::string(Lines::kMaxLine + 1, 'x'));
  add("\n");
  ASSERT_EQ(heard_.size(), 2U);
  EXPECT_EQ(heard_[0].size(), Lines::kMaxLine);
  EXPECT_EQ(heard_[1], "x");
}

TEST_F(LinesTest, TheLastAreKept) {
  for (int i = 0; i < 100; ++i) lines_.keep(std::to_string(i));
  EXPECT_EQ(lines_.last().size(), Lines::kLast);
  EXPECT_EQ(lines_.last().front(), "80");
  EXPECT_EQ(lines_.last().back(), "99");
}

}  // namespace
}  // namespace hc::internal
