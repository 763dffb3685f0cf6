// SPDX-License-Identifier: Apache-2.0
#include <client/running.h>

#include <gtest/gtest.h>

#include <cstdlib>

#include <client/graph_client.h>
#include <client/tap.h>

namespace hc {
namespace {

TEST(Running, graphs_are_found_among_sockets) {
  auto found = find_running(
      "Num       RefCount Protocol Flags    Type St Inode Path\n"
      "0000: 00000002 00000000 00010000 0001 01 1 @hypercolumn.head.12\n"
      "0000: 00000003 00000000 00000000 0001 03 2 @hypercolumn.head.12\n"
      "0000: 00000002 00000000 00010000 0001 01 3 @hypercolumn.head.12.ask\n"
      "0000: 00000002 00000000 00010000 0001 01 4 @hypercolumn.a-B_2.7\n"
      "0000: 00000002 00000000 00010000 0001 01 5 @hypercolumn.head.x\n"
      "0000: 00000002 00000000 00010000 0001 01 6 /run/other\n"
      "0000: 00000002 00000000 00010000 0001 01 7\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].text(), "a-B_2.7");
  EXPECT_EQ(found[1].text(), "head.12");
}

TEST(Running, a_module_knows_its_graph) {
  ::setenv("HC_GRAPH", "head.12", 1);
  ASSERT_TRUE(own_graph());
  EXPECT_EQ(own_graph()->text(), "head.12");
  ::setenv("HC_GRAPH", "head", 1);
  EXPECT_FALSE(own_graph());
  ::unsetenv("HC_GRAPH");
  EXPECT_FALSE(own_graph());
}

TEST(Running, a_graph_that_has_ended_is_an_error) {
  const RunningGraph gone{"no_such_graph", 1};
  const auto answer = ask(gone, {"stop"});
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, Code::Closed);
  EXPECT_FALSE(open_tap(gone, "camera.left"));
}

}  // namespace
}  // namespace hc
