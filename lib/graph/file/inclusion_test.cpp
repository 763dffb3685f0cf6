// SPDX-License-Identifier: Apache-2.0
// Included graphs, and links to URIs.
#include <gtest/gtest.h>

#include <graph/plan/planning_test.h>

namespace hc {
namespace {

const std::string kEye = R"([modules.camera]
program = "posed"
parameters.rate = 1
[modules.follow]
program = "task"
mode = "track"
to.command = "follow.image"
[modes]
track = 1
[frames.lens]
parent = "mount"
[frames.chip]
parent = "lens"
moved_by = "camera.pose"
)" + link_text("camera.left", "follow.image");

TEST(Inclusion, NamesGetThatOfTheGraphBeforeThem) {
  auto planned = must(plan(R"([modules.sink]
[graphs.left]
file = "parts/eye.toml"
modules.camera.parameters.rate = 5
[graphs.right]
file = "parts/eye.toml"
)" + link_text("left_camera.right", "sink.in"),
                           {{"parts/eye.toml", kEye}}));
  std::vector<std::string> names;
  for (const auto& module : planned.modules) names.push_back(module.name);
  EXPECT_EQ(names, (std::vector<std::string>{"sink", "left_camera", "left_follow", "right_camera",
                                             "right_follow"}));
  EXPECT_EQ(planned.modules[1].program, "posed");
  EXPECT_EQ(planned.modules[1].parameters.at("rate"), "5");
  EXPECT_EQ(planned.modules[3].parameters.at("rate"), "1");
  ASSERT_EQ(planned.links.size(), 3U);
  EXPECT_EQ(planned.links[1].from, "left_camera.left");
  EXPECT_EQ(planned.links[2].to, "right_follow.image");
  EXPECT_EQ(planned.modes, (std::map<std::string, std::int64_t>{{"track", 1}}));
  EXPECT_EQ(values_of(planned.modules[4], "--to").front(), "command=12");
}

TEST(Inclusion, WhatIsIncludedIsOverridden) {
  auto planned = must(plan(R"([modules.out]
program = "filter"
inputs.in = "tcp:1"
[graphs.left]
file = "${NO_SUCH_FILE:-parts/eye.toml}"
modules.camera.program = "task"
[graphs.left.modules.follow]
inputs.image = [{ from = "out.out", keep = 5 }, "left_camera.bid"]
outputs.bid = "tcp:2"
)",
                           {{"parts/eye.toml", R"([modules.camera]
program = "source"
[modules.follow]
program = "task"
inputs.image = "camera.left"
)"}}));
  EXPECT_EQ(planned.modules[1].program, "task");
  EXPECT_EQ(links_of(planned),
            "tcp:1 out.in all\nout.out left_follow.image 5\n"
            "left_camera.bid left_follow.image all\nleft_follow.bid tcp:2 all\n");
}

TEST(Inclusion, LinksAreAddedToThoseThatAreIncluded) {
  const std::map<std::string, std::string> files = {{"eye.toml", R"([modules.camera]
program = "source"
[modules.any]
inputs.in = { from = "camera.left", keep = 2 }
[modules.camera.outputs]
left = "tcp:1"
)"},
                                                    {"pair.toml", R"([graphs.eye]
file = "eye.toml"
modules.any.more_inputs.in = "eye_camera.right"
)"}};
  EXPECT_EQ(links_of(plan(R"([modules.eye]
program = "source"
[graphs.pair]
file = "pair.toml"
modules.eye_any.more_inputs.in = ["eye.left", { from = "eye.right", keep = 3 }]
modules.eye_camera.more_outputs.left = "tcp:2"
)",
                          files)),
            "pair_eye_camera.left tcp:1 all\npair_eye_camera.left pair_eye_any.in 2\n"
            "pair_eye_camera.right pair_eye_any.in all\neye.left pair_eye_any.in all\n"
            "eye.right pair_eye_any.in 3\npair_eye_camera.left tcp:2 all\n");
  const auto pair = must(plan("[graphs.pair]\nfile = \"pair.toml\"\n", files));
  ASSERT_EQ(pair.modules.size(), 2U);
  EXPECT_EQ(pair.modules[0].group, "pair_eye");
  EXPECT_EQ(links_of(plan(R"([modules.eye]
program = "source"
[graphs.eye_b]
file = "eye.toml"
modules.any.more_inputs.in = "eye.left"
modules.any.inputs.in = "eye.right"
)",
                          files)),
            "eye_b_camera.left tcp:1 all\neye.right eye_b_any.in all\neye.left eye_b_any.in all\n")
      << "added to those that replace, in any order";
  EXPECT_EQ(wrong(R"([graphs.eye]
file = "eye.toml"
modules.any.more_inputs.in = "eye_camera.left"
)",
                  files),
            "g.toml:4: duplicate link from eye_camera.left to eye_any.in");
}

TEST(Inclusion, EachHasAWorkspaceOfItsOwn) {
  const std::string head = R"([modules.judge]
program = "workspace"
[modules.neck]
program = "actor"
exclusive = ["command"]
[modules.track]
program = "task"
mode = "track"
modes = ["track"]
[modes]
track = 1
[workspace]
module = "judge"
[modules.judge.inputs]
bids = "track.bid"
)";
  auto planned = plan(R"([modules.neck]
program = "actor"
exclusive = ["command"]
[modules.judge]
program = "workspace"
[workspace]
module = "judge"
[graphs.a]
file = "head.toml"
[graphs.b]
file = "head.toml"
)",
                      {{"head.toml", head}});
  EXPECT_EQ(links_of(planned),
            "a_track.bid a_judge.bids all\nb_track.bid b_judge.bids all\n"
            "judge.focus neck.focus latest\na_judge.focus a_neck.focus latest\n"
            "a_judge.focus a_track.focus latest\nb_judge.focus b_neck.focus latest\n"
            "b_judge.focus b_track.focus latest\n");
  EXPECT_EQ(planned->workspaces, (std::set<std::string>{"a_judge", "b_judge", "judge"}));
}

TEST(Inclusion, AFileThatCannotBeReadIsNotMissing) {
  for (const bool is_shipped : {false, true}) {
    Problems problems("g.toml");
    parse_graph(
        "version = 1\n[graphs.a]\nfile = \"b.toml\"\n",
        [](const char*) -> const char* { return nullptr; }, problems,
        [&](const std::string& name) -> Result<std::string> {
          if ((name != "b.toml") == is_shipped) return Error{Code::System, "too many open files"};
          if (is_shipped) return Error{Code::NotFound, "missing"};
          return std::string("version = 1\n");
        });
    EXPECT_EQ(problems.lines(), std::vector<std::string>{"g.toml:3: too many open files"});
  }
}

TEST(Inclusion, ErrorsNameTheFileAndTheLineInIt) {
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"b.toml\"\n",
                  {{"b.toml", "[modules.source]\nparameters.rat = 3\nx = 1\n"}}),
            "b.toml:3: module a_source has no parameter \"rat\", did you mean \"rate\"?\n"
            "b.toml:4: unknown key \"x\" in module source");
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"b.toml\"\n", {{"b.toml", "\nx = \n"}}).substr(0, 9),
            "b.toml:3:");
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"none.toml\"\n"), "g.toml:3: none.toml: cannot be read");
  EXPECT_EQ(
      wrong("[graphs.a]\nfile = \"none.toml\"\n[modules.filter]\ninputs.in = \"a_eye.left\"\n"),
      "g.toml:3: none.toml: cannot be read")
      << "one cause, one error";
  EXPECT_EQ(wrong("[graphs.a]\n"), "g.toml:2: \"file\" is missing in graph a");
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"./x/../g.toml\"\n"), "g.toml:3: g.toml includes itself");
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"b/b.toml\"\n",
                  {{"b/b.toml", "[modules.source]\n[graphs.c]\nfile = \"b.toml\"\n"}}),
            "b/b.toml:4: b/b.toml includes itself");
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"b.toml\"\nmodules.sourc.parameters.rate = 3\n",
                  {{"b.toml", "[modules.source]\n"}}),
            "g.toml:4: graph a has no module \"sourc\", did you mean \"source\"?");
  EXPECT_EQ(wrong("[graphs.a]\nfile = \"b.toml\"\nmodules.source.parameters.rat = 3\n",
                  {{"b.toml", "[modules.source]\n"}}),
            "g.toml:4: module a_source has no parameter \"rat\", did you mean \"rate\"?");
  EXPECT_EQ(wrong("[modules.a_source]\nprogram = \"source\"\n[graphs.a]\nfile = \"b.toml\"\n",
                  {{"b.toml", "[modules.source]\n"}}),
            "b.toml:2: duplicate module \"a_source\"");
}

TEST(Inclusion, IsBounded) {
  std::string many;
  for (int i = 0; i < 20; ++i) many += "[graphs.g" + std::to_string(i) + "]\nfile = \"b.toml\"\n";
  std::string more;
  for (int i = 0; i < 20; ++i) more += "[graphs.h" + std::to_string(i) + "]\nfile = \"c.toml\"\n";
  EXPECT_NE(wrong(many, {{"b.toml", more}, {"c.toml", "[modules.source]\n"}})
                .find("b.toml:9: at most 256 files are included"),
            std::string::npos);
}

TEST(Outside, EndsMayBeUris) {
  auto planned = must(plan("[modules.filter]\n" + link_text("tcp-listen:7000", "filter.in") +
                           link_text("filter.out", "file:out.mtp", "rate = 3\n")));
  EXPECT_EQ(values_of(planned.modules[0], "--in"),
            (std::vector<std::string>{"in=tcp-listen:7000"}));
  EXPECT_EQ(values_of(planned.modules[0], "--out"),
            (std::vector<std::string>{"out=file:out.mtp?rate=3"}));
  EXPECT_EQ(planned.links[0].from, "tcp-listen:7000");
  EXPECT_EQ(planned.links[0].sender_uri, "");
  EXPECT_EQ(planned.links[1].reader_uri, "");
  EXPECT_EQ(planned.links[1].sender_uri, "file:out.mtp?rate=3");
}

TEST(Outside, ErrorsNameTheLineAndWhatWouldBeRight) {
  auto with = [](const std::string& from, const std::string& to, const std::string& more = "") {
    return wrong("[modules.filter]\n" + link_text(from, to, more));
  };
  EXPECT_EQ(with("tpc:1", "filter.in"),
            "g.toml:3: module filter does not support tpc: links, did you mean \"tcp\"?");
  EXPECT_EQ(with("shm:x", "filter.in"), "g.toml:3: module filter does not support shm: links");
  EXPECT_EQ(with("tcp:1?a", "filter.in").substr(0, 9), "g.toml:4:");
  EXPECT_EQ(with("tcp:1", "filter.in", "rate = 3\n"),
            "g.toml:5: a link from outside cannot have rate: its sender sets it");
  EXPECT_EQ(with("filter.out", "tcp:1?rate=2", "rate = 3\n"),
            "g.toml:5: rate is also given in tcp:1?rate=2");
  EXPECT_EQ(with("tcp-listen:1", "filter.in", link_text("filter.out", "tcp-listen:1")),
            "g.toml:5: another link also listens at tcp-listen:1");
}

}  // namespace
}  // namespace hc
