// SPDX-License-Identifier: Apache-2.0
#include <hc/base/visible.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

using namespace std::string_literals;

TEST(Visible, LeavesTextAsItIs) {
  for (const char* text :
       {"", "camera: started", "à → 漢 🤖", "a\tb", "back\\slash", "\\x1b[2J"})
    EXPECT_EQ(visible(text), text);
}

TEST(Visible, ShowsWhatWouldSteerATerminal) {
  EXPECT_EQ(visible("\x1b[2J\x1b]0;title\a"), "\\x1b[2J\\x1b]0;title\\x07");
  EXPECT_EQ(visible("over\rwritten\b\x7f"), "over\\x0dwritten\\x08\\x7f");
  EXPECT_EQ(visible("a\0b\n"s), "a\\x00b\\x0a");
  EXPECT_EQ(visible("\xc2\x9b"
                    "31m \xc2\xa0"),
            "\\xc2\\x9b31m \xc2\xa0");                                     // one-character CSI
  EXPECT_EQ(visible("\xe2\x80"s + "\xae" + "txt"), "\\xe2\\x80\\xaetxt");  // right-to-left override
}

TEST(Visible, ShowsBytesThatAreNoText) {
  EXPECT_EQ(visible("\xff\xfe"), "\\xff\\xfe");
  EXPECT_EQ(visible("\xe2\x82"), "\\xe2\\x82");  // truncated
  EXPECT_EQ(visible("\xc0\x9b"), "\\xc0\\x9b");  // overlong
}

}  // namespace
}  // namespace hc
