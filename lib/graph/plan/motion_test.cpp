// SPDX-License-Identifier: Apache-2.0
// Warnings of hc check: links that can block a module that moves the robot, loops over two actors.
#include <gtest/gtest.h>

#include <graph/plan/planning_test.h>

namespace hc {
namespace {

/// The warnings of a graph, a line each.
std::string warnings(const std::string& text,
                     const std::map<std::string, std::string>& files = {}) {
  const auto planned = plan(text, files);
  EXPECT_TRUE(planned) << planned.error().detail;
  std::string lines;
  if (planned)
    for (const auto& line : planned->warnings) lines += line + "\n";
  return lines;
}

/// A task that turns a source's messages into commands, and a watcher that may read the source.
const std::string kLoop = R"([modules.eye]
program = "source"
[modules.task]
inputs.image = "eye.left"
[modules.actor]
inputs.command = "task.command"
[modules.watcher]
program = "keeper"
)";

TEST(Motion, ALinkThatMayHoldWhatMovesTheRobotIsWarnedOf) {
  EXPECT_EQ(warnings(kLoop), "");
  EXPECT_EQ(warnings(kLoop + "inputs.in = \"eye.left\"\n"), "") << "the newest";
  const auto held = warnings(kLoop + "inputs.in = { from = \"eye.left\", keep = \"all\" }\n");
  EXPECT_TRUE(held.starts_with("g.toml:10: watcher.in can block eye, which controls the robot"))
      << held;
  const auto default_all = warnings(kLoop + "[modules.filter]\ninputs.in = \"task.bid\"\n");
  EXPECT_TRUE(default_all.starts_with("g.toml:11: filter.in can block task")) << default_all;
  EXPECT_EQ(warnings(kLoop + "[modules.filter]\ninputs.in = { from = \"task.bid\", keep = 16 }\n"),
            "");
  EXPECT_EQ(warnings(kLoop + "[modules.other]\nprogram = \"source\"\n[modules.filter]\n"
                             "inputs.in = \"other.left\"\n"),
            "")
      << "neither moves anything";
}

TEST(Motion, ALinkToTheOutsideMayHoldToo) {
  const std::string to = "\n[modules.task.outputs]\nbid = ";
  EXPECT_TRUE(warnings(kLoop + to + "\"tcp:1\"\n").starts_with("g.toml:12: tcp:1 can block task"));
  EXPECT_EQ(warnings(kLoop + to + "\"file:bids\"\n"), "");
}

TEST(Motion, ALoopOverTwoActorsIsWarnedOf) {
  const std::string text = R"([modules.a]
program = "actor"
inputs.command = { from = "of_a.command", rate = 50 }
[modules.of_a]
program = "task"
inputs.image = "b.pose"
[modules.b]
program = "actor"
inputs.command = { from = "of_b.command", rate = 50 }
[modules.of_b]
program = "task"
inputs.image = )";
  const auto crossed = warnings(text + "\"a.pose\"\n");
  EXPECT_TRUE(crossed.starts_with("g.toml:2: loop over two actors: a -> of_b -> b -> of_a -> a; "))
      << crossed;
  EXPECT_EQ(warnings(text + "{ from = \"b.pose\", rate = 3 }\n"), "") << "each has its own";
}

TEST(Motion, TwoHeadsThatSeeForEachOtherAreWarnedOf) {
  const std::map<std::string, std::string> files = {
      {"head.toml",
       "[modules.eye]\nprogram = \"source\"\n[modules.neck]\n"
       "program = \"actor\"\n"}};
  auto of = [](const std::string& name, const std::string& sees) {
    return "[graphs." + name + "]\nfile = \"head.toml\"\nmodules.neck.inputs.command = \"to_" +
           name + ".command\"\n[modules.to_" + name + "]\nprogram = \"task\"\ninputs.image = \"" +
           sees + "_eye.left\"\n";
  };
  const auto crossed = warnings(of("one", "two") + of("two", "one"), files);
  EXPECT_NE(crossed.find("loop over two robots: one_neck -> one_eye -> to_two -> two_neck -> "
                         "two_eye -> to_one -> one_neck; "),
            std::string::npos)
      << crossed;
  EXPECT_EQ(warnings(of("one", "one") + of("two", "two"), files), "");
  EXPECT_EQ(warnings(of("one", "one") + of("two", "one"), files), "") << "one follows the other";
}

}  // namespace
}  // namespace hc
