// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/commands.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

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

  /// Whether a link, if it is one, has its modules, as make_plan() wants it.
  bool has_ends(const std::string& line) {
    auto command = parse_command(line);
    if (!command || command->verb != Command::Verb::Link) return true;
    return std::all_of(command->words.begin(), command->words.begin() + 2, [&](const auto& end) {
      return graph_.find(end.substr(0, end.find('.'))) != nullptr;
    });
  }

  Graph graph_;
};

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
           {"add x", "the command is: add MODULE PROGRAM [PARAMETER=VALUE ...]"},
           {"stop now", "the command is: stop"},
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

/// What is kept of commands.
Lines kept(const Lines& lines) {
  Lines commands;
  for (const auto& line : lines) add_command(commands, line);
  return commands;
}

TEST(AddCommand, TheNextValueTakesThePlaceOfTheOneBefore) {
  EXPECT_EQ(kept({"set a.b=1", "add x y", "set a.c=1", "set a.b=2", "set a.b=3"}),
            (Lines{"set a.b=3", "add x y", "set a.c=1"}));
  EXPECT_EQ(kept({"link a.o b.i rate=1", "link a.o c.i", "link a.o b.i rate=2"}),
            (Lines{"link a.o b.i rate=2", "link a.o c.i"}));
}

TEST(AddCommand, ALinkThatComesAndGoesLeavesNothingNew) {
  // The file may have the link, so that the first of these is not in vain.
  EXPECT_EQ(kept({"unlink a.o b.i", "link a.o b.i", "unlink a.o b.i"}), Lines{"unlink a.o b.i"});
  Lines commands;
  for (int i = 0; i < 10; ++i) {
    add_command(commands, "link a.o b.i rate=" + std::to_string(i));
    add_command(commands, "unlink a.o b.i");
  }
  EXPECT_EQ(commands, (Lines{"link a.o b.i rate=0", "unlink a.o b.i"}));
  // Of a module that was added the file has none.
  EXPECT_EQ(kept({"add b p", "link a.o b.i", "unlink a.o b.i"}), Lines{"add b p"});
}

TEST(AddCommand, AModuleThatGoesTakesAllAlongThatWasSaidOfIt) {
  EXPECT_EQ(kept({"set b.p=1", "add x p", "link a.o x.i", "set x.p=1", "remove x"}),
            Lines{"set b.p=1"});
  EXPECT_EQ(kept({"set b.p=1", "link a.o b.i", "remove b"}), Lines{"remove b"});
  EXPECT_EQ(kept({"remove b", "add b p", "set b.p=2", "remove b"}), Lines{"remove b"});
  EXPECT_EQ(kept({"remove b", "add b p", "set b.p=2", "set b.p=3"}),
            (Lines{"remove b", "add b p", "set b.p=3"}));
  EXPECT_EQ(kept({"link a.o tcp:b.i:7", "remove b"}), (Lines{"link a.o tcp:b.i:7", "remove b"}));
}

/// A graph in words, to compare.
std::string text_of(const Graph& graph) {
  std::string text;
  for (const auto& module : graph.modules) {
    text += module.name + " " + module.program.value;
    for (const auto& [key, value] : module.parameters) text += " " + key + "=" + value.value;
    text += "\n";
  }
  for (const auto& link : graph.links) {
    text += link.from.text() + " " + link.to.text() + (link.routes_all ? " route" : "");
    for (const auto& [key, value] : link.policy) text += " " + key + "=" + value.value;
    text += "\n";
  }
  return text;
}

TEST_F(CommandsTest, WhatIsKeptMakesTheSameGraph) {
  graph_.links[0].routes_all = true;
  const Graph file = graph_;
  std::minstd_rand random(1);
  auto any = [&](const Lines& words) { return words[random() % words.size()]; };
  std::size_t longest = 0;
  for (int round = 0; round < 200; ++round) {
    graph_ = file;
    Lines commands;
    for (int i = 0; i < 100; ++i) {
      const std::string module = any({"camera", "view", "more"});
      const std::string ends = any({"camera.left ", "more.left "}) + any({"view.image", "more.in"});
      const std::string number = std::to_string(random() % 10);
      const std::string line =
          any({"set " + module + ".rate=" + number, "add " + module + " p", "remove " + module,
               "link " + ends + " rate=" + number, "unlink " + ends});
      const Graph before = graph_;
      if (!has_ends(line) || !apply(line).empty()) {
        graph_ = before;
        continue;
      }
      add_command(commands, line);
      const Graph after = std::exchange(graph_, file);
      for (const auto& each : commands) ASSERT_EQ(apply(each), "") << each << " then " << line;
      ASSERT_EQ(text_of(graph_), text_of(after)) << line;
    }
    longest = std::max(longest, commands.size());
  }
  EXPECT_LE(longest, 24U);
}

}  // namespace
}  // namespace hc
