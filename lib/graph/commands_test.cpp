// SPDX-License-Identifier: Apache-2.0
#include <graph/graph_file.h>

#include <gtest/gtest.h>

#include <utility>

namespace hc {
namespace {

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

  /// Applies a command. Returns its problems; empty: none.
  std::string apply(const std::string& line) {
    auto command = parse_graph_command(line);
    if (!command) return command.error().detail;
    Problems problems("");
    apply_command(graph_, *command, problems);
    return problems.empty() ? "" : problems.lines().at(0);
  }

  Graph graph_;
};

TEST_F(CommandsTest, AGraphHasAtMost1000Modules) {
  for (std::size_t i = graph_.modules.size(); i < kMaxModules; ++i)
    ASSERT_EQ(apply("add m" + std::to_string(i) + " blob"), "");
  EXPECT_EQ(apply("add one_more blob"), "a graph has at most 1000 modules");
}

TEST_F(CommandsTest, ModulesComeAndGoWithTheirLinks) {
  EXPECT_EQ(apply("add blob blob_finder hue=0.3 name=a=b"), "");
  ASSERT_NE(graph_.find("blob"), nullptr);
  EXPECT_EQ(graph_.find("blob")->program.value, "blob_finder");
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

TEST_F(CommandsTest, ALinkToObserversWaitsForNone) {
  EXPECT_EQ(apply("link camera.left shm:s"), "");
  EXPECT_EQ(graph_.links.at(1).policy.at("keep").value, "latest");
  EXPECT_EQ(graph_.links.at(1).policy.at("readers").value, "0");
  EXPECT_EQ(apply("link camera.left tcp-listen:7000?readers=1 keep=all"), "");
  EXPECT_EQ(graph_.links.at(2).policy.at("keep").value, "all");
  EXPECT_FALSE(graph_.links.at(2).policy.contains("readers"));
  EXPECT_EQ(apply("link camera.left file:a.mtp"), "");
  EXPECT_TRUE(graph_.links.at(3).policy.empty());
}

TEST_F(CommandsTest, AValueMayHoldAnything) {
  EXPECT_EQ(apply("set camera.set=a = b  c"), "");
  EXPECT_EQ(graph_.modules[0].parameters.at("set").value, "a = b  c");
}

TEST_F(CommandsTest, WhatIsWrongIsNamed) {
  for (const auto& [line, words] : std::vector<std::pair<std::string, std::string>>{
           {"", "there is no command"},
           {"ad x y", "no command \"ad\", did you mean \"add\"?"},
           {"add x", "usage: add MODULE[@HOST] PROGRAM [PARAMETER=VALUE ...]"},
           {"stop now", "usage: stop"},
           {"add X y", "module name \"X\" is not snake_case"},
           {"add view y", "module \"view\" already exists"},
           {"add x y z", "\"z\" is not KEY=VALUE"},
           {"remove viw", "no module \"viw\", did you mean \"view\"?"},
           {"link camera view.image", "\"camera\" is not MODULE.PORT"},
           {"link camera.left view.image kep=3",
            "unknown key \"kep\" in a link, did you mean \"keep\"?"},
           {"link camera.left view.image rate=fast", "option rate is"},
           {"link tcp:1 tcp:2", "a link needs a module at one of its ends"},
           {"unlink camera.left view.x", "no link from camera.left to view.x"},
           {"set camra.rate=3", "did you mean \"camera\"?"}}) {
    EXPECT_NE(apply(line).find(words), std::string::npos) << line << ": " << apply(line);
  }
}

}  // namespace
}  // namespace hc
