// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/log_line.h>

#include <array>

#include <gtest/gtest.h>

#include <hc/mtp/rows.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

TEST(LogLine, a_report_says_its_level) {
  for (const auto level :
       {Level::Info, Level::Warning, Level::Error, Level::Result, Level::Notice}) {
    const auto line = must(read_log(make_log(level, "said: two words")));
    EXPECT_EQ(line.level, level);
    EXPECT_EQ(line.text, "said: two words");
  }
  for (const char* wrong : {"", "fatal: x", "Error x"})
    EXPECT_FALSE(read_log(make_rows(std::array{std::string(wrong)}))) << wrong;
}

TEST(LogLine, json_brings_back_what_was_said) {
  const auto line = must(parse_log_line(to_json({"camera", Level::Error, "no \"device\"\\"})));
  EXPECT_EQ(line.module, "camera");
  EXPECT_EQ(line.level, Level::Error);
  EXPECT_EQ(line.line(), "camera: error: no \"device\"\\");
  EXPECT_TRUE(parse_log_line(to_json({"a", Level::Info, "\xff"})));
  for (const char* wrong : {"", "[]", "{}", R"({"module":"a","level":3,"text":"b"})",
                            R"({"module":"a","level":"loud","text":"b"})"})
    EXPECT_FALSE(parse_log_line(wrong)) << wrong;
}

TEST(LogLine, a_terminal_shows_errors) {
  EXPECT_EQ((LogLine{"a", Level::Result, "3 px"}.line()), "a: 3 px");
  EXPECT_EQ((LogLine{"a", Level::Warning, "late"}.line()), "a: late");
  EXPECT_EQ((LogLine{"a", Level::Error, "not saved"}.line()), "a: error: not saved");
}

}  // namespace
}  // namespace hc
