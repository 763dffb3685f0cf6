// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/running_graph.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(RunningGraph, a_name_and_a_process_are_a_graph) {
  const auto graph = parse_running_graph("a-B_2.7");
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->name, "a-B_2");
  EXPECT_EQ(graph->process, 7);
  EXPECT_EQ(graph->state_uri(), "unix:@hypercolumn.a-B_2.7");
  EXPECT_EQ(graph->command_uri(), "unix:@hypercolumn.a-B_2.7.ask");
}

TEST(RunningGraph, any_other_name_is_none) {
  // Any program may bind a name, also with terminal control characters.
  for (const std::string& name :
       {std::string(""), std::string("head"), std::string("a.b.7"), std::string("\x1b[2J.7"),
        std::string("å.7"), std::string(".7"), std::string("a.-7"), std::string("a.0"),
        std::string("a."), std::string("a.7.ask"), std::string("a.99999999999"),
        std::string(kMaxGraphName + 1, 'a') + ".7"})
    EXPECT_FALSE(parse_running_graph(name)) << name;
}

}  // namespace
}  // namespace hc
