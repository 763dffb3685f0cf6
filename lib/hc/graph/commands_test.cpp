// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/commands.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

using Lines = std::vector<std::string>;

class CommandsTest : public ::testing::Test {
 protected:
  CommandsTest() {
    graph_.modules.resize(2);
    graph_.modules[0].name = "camera";
    graph_.modules[1].name = "view";
    graph_.links.resize(1);
    graph_.links[0].from = {"camera", "left", ""};
    graph_.links[0].to = {"view", "image", ""};
  }

  /// What is wrong with a command; empty: it has been applied.
  std::string apply(const std::string& line) {
    auto command = parse_command(line);
    if (!command) return command.error().detail;
    Problems problems("");
    apply_command(graph_, *command, problems);
    return problems.empty() ? "" : problems.lines().at(0);
  }

  Graph graph_;
};

TEST_F(CommandsTest, ModulesComeAndGoWithTheirLinks) {
  EXPECT_EQ(apply("add blob blob_finder hue=0.3 name=a=b"), "");
  ASSERT_NE(graph_.find("blob"), nullptr);
  EXPECT_EQ(graph_.find("blob")->program, "blob_finder");
  EXPECT_EQ(graph_.find("blob")->parameters.at("name").value, "a=b");
  EXPECT_EQ(apply("link camera.left blob.image keep=latest rate=5"), "");
  ASSERT_EQ(graph_.links.size(), 2U);
  EXPECT_EQ(graph_.links[1].policy.at("rate").value, "5");
  EXPECT_EQ(apply("remove blob"), "");
  EXPECT_EQ(graph_.links.size(), 1U);
  EXPECT_EQ(apply("unlink camera.left view.image"), "");
  EXPECT_TRUE(graph_.links.empty());
}

TEST_F(CommandsTest, ALinkThatIsThereGetsAnotherPolicy) {
  EXPECT_EQ(apply("link camera.left view.image rate=5"), "");
  ASSERT_EQ(graph_.links.size(), 1U);
  EXPECT_EQ(graph_.links[0].policy.at("rate").value, "5");
}

TEST_F(CommandsTest, TheWorldOutsideIsLinkedByItsUri) {
  EXPECT_EQ(apply("link camera.left tcp:robot:7000"), "");
  EXPECT_EQ(graph_.links.at(1).to.uri, "tcp:robot:7000");
  EXPECT_EQ(apply("unlink camera.left tcp:robot:7000"), "");
}

TEST_F(CommandsTest, AValueMayHoldAnything) {
  EXPECT_EQ(apply("set camera.set=a = b  c"), "");
  EXPECT_EQ(graph_.modules[0].parameters.at("set").value, "a = b  c");
}

TEST_F(CommandsTest, WhatIsWrongIsNamed) {
  for (const auto& [line, words] : std::vector<std::pair<std::string, std::string>>{
           {"", "there is no command"},
           {"ad x y", "no command \"ad\", did you mean \"add\"?"},
           {"add x", "the command is: add MODULE PROGRAM [PARAMETER=VALUE ...]"},
           {"stop now", "the command is: stop"},
           {"add X y", "a module's name is snake_case, not \"X\""},
           {"add view y", "there is a module \"view\" already"},
           {"add x y z", "\"z\" is not KEY=VALUE"},
           {"remove viw", "no module \"viw\", did you mean \"view\"?"},
           {"link camera view.image", "\"camera\" is not MODULE.PORT"},
           {"link camera.left view.image kep=3",
            "no key \"kep\" in a link, did you mean \"keep\"?"},
           {"link camera.left view.image rate=fast", "option rate is"},
           {"link tcp:1 tcp:2", "a link has a module at one of its ends"},
           {"unlink camera.left view.x", "no link from camera.left to view.x"},
           {"set camra.rate=3", "did you mean \"camera\"?"}}) {
    EXPECT_NE(apply(line).find(words), std::string::npos) << line << ": " << apply(line);
  }
}

TEST_F(CommandsTest, OnlyTheLastOfASliderIsKept) {
  Lines commands;
  for (const char* line : {"set a.b=1", "add x y", "set a.c=1", "set a.b=2", "restart a"})
    add_command(commands, line);
  EXPECT_EQ(commands, (Lines{"add x y", "set a.c=1", "set a.b=2", "restart a"}));
}

}  // namespace
}  // namespace hc
