// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/command.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(ModuleCommand, EachComesBackAsItWasWritten) {
  for (const char* row : {"set rate=5", "set text= a = b ", "link in left=unix:@a?wait=1",
                          "link out out=shm:b", "unlink in focus=unix:@f", "finish in=unix:@a",
                          "route out=shm:b to=21,-5 peer=eye", "wall_offset -5"}) {
    auto command = parse_module_command(row);
    ASSERT_TRUE(command) << row;
    EXPECT_EQ(text(*command), row);
  }
}

TEST(ModuleCommand, AnythingElseIsRefused) {
  for (const char* row : {"", "set", "set rate", "sit rate=5", "link left=unix:@a", "link in",
                          "unlink on a=b", "finish"}) {
    auto command = parse_module_command(row);
    ASSERT_FALSE(command) << row;
    EXPECT_EQ(command.error().code, Code::Invalid);
  }
}

}  // namespace
}  // namespace hc
