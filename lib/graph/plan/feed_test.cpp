// SPDX-License-Identifier: Apache-2.0
// Which inputs programs outside may send to: nothing moves the robot without the focus.
#include <gtest/gtest.h>

#include <graph/plan/planning_test.h>

namespace hc {
namespace {

/// Why an input of a graph cannot be sent to; empty: it can.
std::string refusal(const std::string& text, const std::string& input) {
  const auto planned = plan(text);
  EXPECT_TRUE(planned) << planned.error().detail;
  const auto checked = planned ? check_feed(*planned, input) : Status();
  return checked ? "" : checked.error().detail;
}

/// A filter whose messages lead to an actor through `task`.
const std::string kTail = R"(
inputs.image = "filter.out"
[modules.eye]
program = "source"
[modules.filter]
inputs.in = "eye.left"
[modules.actor]
inputs.command = "task.command"
)";
const std::string kTask = "[modules.task]\nmode = \"look\"" + kTail + R"(exclusive = ["command"]
[modes]
look = 1
[workspace]
module = "workspace"
[modules.workspace]
inputs.bids = "task.bid"
)";

TEST(Feed, ATaskMayBeSentTo) {
  EXPECT_EQ(refusal(kTask, "task.image"), "");
  EXPECT_EQ(refusal(kTask, "filter.in"), "") << "through a task";
  EXPECT_EQ(refusal("[modules.any]\n", "any.in"), "") << "leads nowhere";
}

TEST(Feed, WhatMovesSomethingMayNot) {
  EXPECT_EQ(refusal(kTask, "actor.command"),
            "actor.command obeys the task in focus only: send to an input of a task");
  EXPECT_EQ(refusal("[modules.actor]\n", "actor.command"),
            "actor.command obeys the task in focus only: send to an input of a task");
  const std::string without_task = "[modules.task]" + kTail;
  EXPECT_EQ(refusal(without_task, "filter.in"),
            "filter.in leads to actor.command, which obeys the task in focus only, and not "
            "through a task");
  EXPECT_EQ(
      refusal("[modules.router]\n[modules.actor]\ninputs.command = \"router.out\"\n", "router.in"),
      "router.in leads to actor.command, which obeys the task in focus only, and not "
      "through a task");
}

TEST(Feed, WhatDecidesOnTheFocusMayNot) {
  for (const std::string input : {"workspace.bids", "task.focus"})
    EXPECT_EQ(refusal(kTask, input),
              input + " decides on the focus: only the links of the graph lead there");
  auto text = kTask;
  text.insert(text.find("inputs.image"), "exclusive = [\"image\"]\n");
  EXPECT_EQ(refusal(text, "task.image"),
            "task.image obeys the task in focus only: send to an input of a task");
}

TEST(Feed, WhatIsNoInputIsNamed) {
  EXPECT_EQ(refusal(kTask, "filter.inn"), "no input \"filter.inn\", did you mean \"filter.in\"?");
  EXPECT_EQ(refusal(kTask, "eye.left"), "no input \"eye.left\"");
  EXPECT_EQ(refusal("[modules.seer]\n", "seer.in"), "");
  EXPECT_EQ(refusal("[modules.fixed]\n", "fixed.any"),
            "fixed.any cannot be sent to: its program does not support unix-listen");
}

}  // namespace
}  // namespace hc
