// SPDX-License-Identifier: Apache-2.0
// Modes, focus, exclusive inputs and actors, from the file to the commands.
#include <gtest/gtest.h>

#include <graph/plan/planning_test.h>

namespace hc {
namespace {

using Strings = std::vector<std::string>;

const std::string kModes = R"([modules.track]
program = "task"
mode = "track"
[modules.read]
program = "task"
mode = "read"
modes = ["read"]
[modules.actor]
exclusive = ["command"]
[modules.workspace]
[modes]
track = 1
read = 3
[workspace]
module = "workspace"
)" + link_text("track.command", "actor.command") +
                           link_text("read.command", "actor.command") +
                           link_text("read.bid", "workspace.bids");
const std::string kBid = link_text("track.bid", "workspace.bids");

TEST(Modes, ModulesGetTheirModes) {
  auto planned = must(plan(kModes + kBid));
  EXPECT_EQ(planned.modes, (std::map<std::string, std::int64_t>{{"read", 3}, {"track", 1}}));
  EXPECT_EQ(planned.workspaces, std::set<std::string>{"workspace"});
  EXPECT_EQ(values_of(planned.modules[0], "--mode"), (Strings{"1"}));
  EXPECT_EQ(values_of(planned.modules[1], "--modes"), (Strings{"3"}));
  EXPECT_EQ(values_of(planned.modules[2], "--exclusive"), (Strings{"command"}));
  EXPECT_EQ(planned.modules[3].parameters.at("mode_names"), "read=3,track=1");
  EXPECT_EQ(planned.modules[3].parameters.at("source_names"), "read.bid=4,track.bid=2");
  EXPECT_EQ(planned.modules[0].mode, "track");
  EXPECT_EQ(planned.modules[1].modes, (Strings{"read"}));
  EXPECT_EQ(planned.modules[2].exclusive, (std::set<std::string>{"command"}));
}

TEST(Modes, ModulesGetTheirClock) {
  const auto planned = must(plan("[modules.task]\nclock = \"messages\"\n[modules.actor]\n"));
  EXPECT_EQ(values_of(planned.modules[0], "--clock"), (Strings{"messages"}));
  EXPECT_EQ(values_of(planned.modules[1], "--clock"), Strings());
  EXPECT_EQ(wrong("[modules.task]\nclock = \"sun\"\n"),
            "g.toml:3: \"clock\" must be \"machine\" or \"messages\"");
}

TEST(Modes, ModulesThatShowThemGetTheirNames) {
  auto planned =
      must(plan("[modules.titled]\n[modules.other]\nprogram = \"titled\"\nparameters.mode_names = "
                "\"mine=1\"\n"
                "[modules.counted]\n" +
                kModes + kBid));
  EXPECT_EQ(planned.modules[0].parameters.at("mode_names"), "read=3,track=1");
  EXPECT_EQ(planned.modules[1].parameters.at("mode_names"), "mine=1");
  EXPECT_FALSE(planned.modules[2].parameters.contains("mode_names"));
  const auto without = must(plan("[modules.titled]\n"));
  EXPECT_FALSE(without.modules[0].parameters.contains("mode_names"));
}

TEST(Modes, TheFocusIsLinkedToWhoFollowsIt) {
  auto planned = must(plan(kModes + kBid));
  EXPECT_EQ(
      values_of(planned.modules[3], "--out"),
      (Strings{"focus=unix-listen:@t.workspace.focus.read.focus?readers=1&stay=1&keep=latest",
               "focus=unix-listen:@t.workspace.focus.actor.focus?readers=1&stay=1&keep=latest"}));
  EXPECT_EQ(values_of(planned.modules[1], "--in"),
            (Strings{"focus=unix:@t.workspace.focus.read.focus?reconnect=86400"}));
  ASSERT_EQ(planned.links.size(), 6U);
  EXPECT_EQ(planned.links[5].from, "workspace.focus");
  EXPECT_EQ(planned.links[5].to, "actor.focus");
  // A loop through the focus needs no rate.
  EXPECT_EQ(wrong(kModes + kBid), "");
  EXPECT_EQ(
      wrong(kModes),
      "g.toml:13: mode track never gets the focus: no module with mode = \"track\" sends bids "
      "to a workspace");
  // A link of the focus in the file is not duplicated.
  auto own = must(plan(kModes + kBid + link_text("workspace.focus", "actor.focus")));
  EXPECT_EQ(own.links.size(), 6U);
}

TEST(Modes, AWorkspaceThatIsNotDeclaredIsWarnedOf) {
  const auto planned = must(plan("[modules.judge]\nprogram = \"workspace\"\n"));
  EXPECT_EQ(planned.warnings,
            Strings{"g.toml:2: module judge takes bids, but no task gets the focus from it: add "
                    "[workspace] with module = \"judge\""});
}

TEST(Modes, ABidderWithoutAModeIsWarnedOf) {
  EXPECT_TRUE(must(plan(kModes + kBid)).warnings.empty());
  const auto other = "[modules.other]\nprogram = \"task\"\n";
  const auto planned = must(plan(kModes + kBid + other + link_text("other.bid", "workspace.bids")));
  ASSERT_EQ(planned.warnings.size(), 1U);
  EXPECT_TRUE(planned.warnings[0].ends_with(
      ": module other bids without a mode, which is refused: add mode = \"NAME\", unless its "
      "messages have one"))
      << planned.warnings[0];
}

TEST(Modes, ErrorsNameTheLineAndWhatWouldBeRight) {
  EXPECT_EQ(wrong("[modules.task]\nmode = \"trak\"\n[modes]\ntrack = 1\n[modules.other]\n"
                  "program = \"task\"\nmode = \"track\"\n"),
            "g.toml:3: no mode \"trak\", did you mean \"track\"?");
  EXPECT_EQ(wrong("[modules.task]\nmodes = [\"x\", \"y\"]\n"),
            "g.toml:3: no mode \"x\"\ng.toml:3: no mode \"y\"");
  EXPECT_EQ(wrong("[modules.task]\nmode = \"a\"\n[modes]\na = 1\nb = 2\n"),
            "g.toml:6: mode b has no task: no module has mode = \"b\"");
  EXPECT_EQ(wrong("[modules.task]\nmode = \"a\"\n[modules.b]\nprogram = \"task\"\nmode = \"b\"\n"
                  "[modes]\na = 1\nb = 1\n"),
            "g.toml:9: modes a and b have the same number");
  EXPECT_EQ(wrong("[modules.task]\n[modules.actor]\nexclusive = [\"command\"]\n"
                  "inputs.command = \"task.command\"\n"),
            "g.toml:4: exclusive inputs require a [workspace] table: add it with module = "
            "\"workspace\", and [modules.workspace]; or set exclusive = []");
  EXPECT_TRUE(plan("[modules.actor]\nexclusive = []\n"));
  EXPECT_TRUE(plan("[modules.actor]\nexclusive = [\"command\"]\n")) << "nothing is linked to it";
  EXPECT_EQ(wrong("[modules.workspace]\n[modules.actor]\nexclusive = [\"comand\"]\n"
                  "[workspace]\nmodule = \"workspace\"\n"),
            "g.toml:4: module actor has no input \"comand\", did you mean \"command\"?");
  EXPECT_EQ(wrong("[modules.workspace]\n[workspace]\nmodule = \"workspac\"\n"),
            "g.toml:4: no module \"workspac\", did you mean \"workspace\"?");
  EXPECT_EQ(wrong("[modules.task]\n[workspace]\nmodule = \"task\"\n"),
            "g.toml:4: module task has no output \"focus\"");
}

TEST(Modes, ProgramsThatKnowNoControlAreNotAsked) {
  auto refused = [](const std::string& line, const std::string& key) {
    EXPECT_TRUE(wrong("[modules.filter]\n" + line + "\n")
                    .starts_with("g.toml:3: module filter cannot have \"" + key +
                                 "\": its program does not support --control"))
        << wrong("[modules.filter]\n" + line + "\n");
  };
  refused("mode = \"a\"", "mode");
  refused("modes = [\"a\"]", "modes");
  refused("exclusive = [\"in\"]", "exclusive");
  refused("clock = \"messages\"", "clock");
}

TEST(Modes, AnActorHasOneWriterUnlessItIsExclusiveOrRouted) {
  const std::string modules =
      "[modules.a]\nprogram = \"task\"\n[modules.b]\nprogram = \"task\"\n[modules.actor]\n"
      "[modules.router]\n[modules.other]\nprogram = \"router\"\n";
  EXPECT_EQ(wrong(modules + link_text("a.command", "actor.command")), "");
  EXPECT_EQ(wrong(modules + link_text("a.command", "actor.command") +
                  link_text("b.command", "actor.command")),
            "g.toml:12: actor.command is an actor's input and gets commands from a.command and "
            "b.command; make it exclusive, or put a router before it");
  EXPECT_EQ(wrong(modules + link_text("router.out", "actor.command") +
                  link_text("other.out", "actor.command")),
            "");
}

TEST(Modes, ModulesAreStartedAgainAsTheFileSays) {
  auto planned =
      must(plan("restart = \"never\"\n[modules.source]\n[modules.sink]\nrestart = \"always\"\n"
                "[modules.any]\nrestart = \"failure\"\n"));
  EXPECT_EQ(planned.modules[0].restart, Restart::Never);
  EXPECT_EQ(planned.modules[1].restart, Restart::Always);
  EXPECT_EQ(planned.modules[2].restart, Restart::Failure);
  EXPECT_EQ(plan("[modules.source]\n")->modules[0].restart, Restart::Failure);
  EXPECT_EQ(wrong("restart = \"nevr\"\n[modules.source]\nrestart = 3\n"),
            "g.toml:2: \"restart\" must be \"never\", \"failure\" or \"always\", did you mean "
            "\"never\"?\ng.toml:4: \"restart\" must be \"never\", \"failure\" or \"always\"");
}

}  // namespace
}  // namespace hc
