// SPDX-License-Identifier: Apache-2.0
// Addresses, groups and routes, from the file to the commands.
#include <gtest/gtest.h>

#include <graph/plan/planning_test.h>

namespace hc {
namespace {

using Strings = std::vector<std::string>;

const std::string kRouted = R"([modules.task]
to = { command = "actor.command", bid = "all" }
[modules.router]
[modules.actor]
[modules.other]
program = "actor"
addresses.command = 22
)" + link_text("task.command", "router.in") +
                            link_text("router.out", "actor.command") +
                            link_text("router.out", "other.command");

TEST(Numbering, InputsGroupsAndRoutesReachTheModules) {
  auto planned = must(plan(kRouted));
  // Outputs come first: task has 1 and 2, router 3 and 4, actor 5, other 6.
  EXPECT_EQ(planned.addresses,
            (std::map<std::string, std::int64_t>{{"actor.command", 7}, {"other.command", 22}}));
  EXPECT_EQ(values_of(planned.modules[0], "--to"), (Strings{"bid=-1", "command=7"}));
  EXPECT_EQ(
      values_of(planned.modules[1], "--route"),
      (Strings{
          "in=unix:@t.task.command.router.in?reconnect=86400 peer=task",
          "out=unix-listen:@t.router.out.actor.command?readers=1&stay=1 to=-1,7 peer=actor",
          "out=unix-listen:@t.router.out.other.command?readers=1&stay=1 to=-1,22 peer=other"}));
  EXPECT_TRUE(values_of(planned.modules[2], "--route").empty());
}

TEST(Numbering, AddresseesAreNumbersGroupsInputsOrAll) {
  auto to = [](const std::string& value, const std::string& more = "") {
    auto planned = plan("[modules.task]\nto.command = " + value + "\n" + more);
    if (!planned) return planned.error().detail;
    return values_of(planned->modules[0], "--to").front();
  };
  EXPECT_EQ(to("21", "addresses.image = 21\n"), "command=21");
  EXPECT_EQ(to("21"), "g.toml:3: no input has the address 21");
  EXPECT_EQ(to("-5"), "command=-5");
  EXPECT_EQ(to("\"all\""), "command=-1");
  EXPECT_EQ(to("\"task.image\""), "command=3");
  EXPECT_EQ(to("\"al\""), "g.toml:3: no input \"al\", did you mean \"all\"?");
  EXPECT_EQ(to("\"task.imag\""), "g.toml:3: no input \"task.imag\", did you mean \"task.image\"?");
}

TEST(Numbering, ErrorsNameTheLineAndWhatWouldBeRight) {
  EXPECT_EQ(wrong("[modules.actor]\naddresses = { command = 7, pose = 7 }\n"),
            "g.toml:3: address 7 is used twice");
  EXPECT_EQ(wrong("[modules.actor]\naddresses.comand = 7\n"),
            "g.toml:3: module actor has no port \"comand\", did you mean \"command\"?");
  EXPECT_EQ(wrong("[modules.task]\nto.comand = 3\n"),
            "g.toml:3: module task has no output \"comand\", did you mean \"command\"?");
  EXPECT_EQ(wrong("[modules.filter]\nto.out = 3\n"),
            "g.toml:3: module filter cannot have \"to\": its program does not support --control; "
            "see spec/module.md, sections 3 and 6");
}

TEST(Numbering, TheFileMaySayTheRoute) {
  auto planned =
      must(plan("[modules.router]\n" + link_text("router.out", "tcp:7000", "route = \"all\"\n") +
                link_text("router.out", "tcp:7001", "route = [21, 0, -5]\n") +
                link_text("router.out", "tcp:7002")));
  EXPECT_EQ(values_of(planned.modules[0], "--route"),
            (Strings{"out=tcp:7000 to=*", "out=tcp:7001 to=21,0,-5", "out=tcp:7002 to=-1"}));
  EXPECT_EQ(
      wrong("[modules.filter]\n" + link_text("filter.out", "tcp:1", "route = [1]\n")),
      "g.toml:5: module filter cannot have \"route\": its program does not support --control; "
      "see spec/module.md, sections 3 and 6");
}

TEST(Numbering, NumbersStayWhenAGraphIsPlannedAnew) {
  auto before = must(plan(kRouted));
  std::string text = "[modules.first]\nprogram = \"task\"\n" + kRouted;
  auto planned = must(plan(text, {}, &before));
  EXPECT_EQ(planned.modules[1].options, before.modules[0].options);
  EXPECT_EQ(planned.addresses.at("actor.command"), before.addresses.at("actor.command"));
  for (const auto& [port, source] : before.sources) EXPECT_EQ(planned.sources.at(port), source);
}

TEST(Numbering, WhatARouterSaysOfItselfIsNotRouted) {
  auto planned =
      must(plan("[modules.router]\n[modules.any]\n" + link_text("router.counts", "any.in") +
                link_text("router.counts", "file:counts.mtp")));
  EXPECT_TRUE(values_of(planned.modules[0], "--route").empty());
  EXPECT_TRUE(planned.addresses.empty());
}

TEST(Numbering, WhatARouterPassesHasALinkOfItsOwn) {
  auto planned = must(plan(kRouted));
  EXPECT_NE(planned.links[1].sender_uri, planned.links[2].sender_uri);
}

}  // namespace
}  // namespace hc
