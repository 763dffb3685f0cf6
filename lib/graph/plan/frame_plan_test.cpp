// SPDX-License-Identifier: Apache-2.0
// Frames, from the file to the modules that take them.
#include <gtest/gtest.h>

#include <graph/plan/planning_test.h>

namespace hc {
namespace {

TEST(Frames, ModulesGetThemAsText) {
  auto planned = must(plan(R"([modules.framed]
[modules.own]
program = "framed"
parameters.frames = "mine"
[modules.neck]
addresses.pose = 11
[frames.head]
parent = "robot"
translation = [0, 0.5, 1.25]
[frames.left_eye]
parent = "head"
moved_by = "neck.pose"
[frames.nose]
parent = "head"
rotation = [180, 0, 0]
coord = 200
)"));
  EXPECT_EQ(planned.modules[0].parameters.at("frames"),
            "head 3 robot 0 0.5 1.25 0 0 0 1; left_eye 4 head neck.pose 11; "
            "nose 200 head 0 0 0 1 0 0 0");
  EXPECT_EQ(planned.modules[1].parameters.at("frames"), "mine");
  EXPECT_EQ(planned.frames, planned.modules[0].parameters.at("frames"));
  EXPECT_TRUE(planned.modules[2].parameters.empty());
  EXPECT_TRUE(planned.modules[0].known.at("file").options.fixed);
}

constexpr const char* kFramedHead = R"([modules.framed]
[frames.head]
parent = "world"
translation = [0, 0, 1]
[frames.cup]
parent = "head"
)";

TEST(Frames, OfAnIncludedFileHaveTheNamesThatItGivesThem) {
  auto planned = must(
      plan("[modules.framed]\n[graphs.one]\nfile = \"head.toml\"\n", {{"head.toml", kFramedHead}}));
  EXPECT_EQ(planned.modules[0].parameters.at("frames"),
            "head 3 world 0 0 1 0 0 0 1; one_cup 0 head 0 0 0 0 0 0 1")
      << "outside of it, the standard ones";
  EXPECT_EQ(planned.modules[1].parameters.at("frames"),
            "head 3 world 0 0 1 0 0 0 1; cup 0 head 0 0 0 0 0 0 1");
}

TEST(Frames, OfTwoHeadsAreDistinguished) {
  auto planned =
      must(plan("[modules.framed]\n[graphs.one]\nfile = \"head.toml\"\n"
                "[graphs.two]\nfile = \"head.toml\"\n",
                {{"head.toml", kFramedHead}}));
  EXPECT_EQ(planned.modules[0].parameters.at("frames"),
            "one_head 0 world 0 0 1 0 0 0 1; one_cup 0 one_head 0 0 0 0 0 0 1; "
            "two_head 0 world 0 0 1 0 0 0 1; two_cup 0 two_head 0 0 0 0 0 0 1");
  EXPECT_EQ(planned.modules[1].parameters.at("frames"),
            "head 3 world 0 0 1 0 0 0 1; cup 0 head 0 0 0 0 0 0 1; "
            "two_head 0 world 0 0 1 0 0 0 1; two_cup 0 two_head 0 0 0 0 0 0 1");
}

TEST(Frames, OfTwoGraphsThatIncludeAHeadEachHasItsOwn) {
  auto planned =
      must(plan("[graphs.one]\nfile = \"task.toml\"\n[graphs.two]\nfile = \"task.toml\"\n",
                {{"head.toml", kFramedHead},
                 {"task.toml", "[modules.framed]\n[graphs.own]\nfile = \"head.toml\"\n"}}));
  for (const auto& module : planned.modules) {
    const std::string other = module.name.starts_with("one_") ? "two_own_head" : "one_own_head";
    const std::string& frames = module.parameters.at("frames");
    EXPECT_NE((" " + frames).find(" head 3 world"), std::string::npos) << frames;
    EXPECT_NE(frames.find(other + " 0 world"), std::string::npos) << frames;
  }
}

constexpr const char* kMoved = R"([modules.neck]
[modules.seeker]
[frames.head]
parent = "robot"
moved_by = "neck.pose"
[frames.gripper]
parent = "robot"
coord = 100
moved_by = "seeker.pose"
[frames.finger]
parent = "gripper"
coord = 101
moved_by = "neck.pose"
)";

TEST(Frames, WhatMovesThemIsLinkedToWhoAsksForThem) {
  auto planned = plan(kMoved);
  EXPECT_EQ(links_of(planned), "neck.pose seeker.frames 1024\n")
      << "once, and not what the seeker itself moves";
  EXPECT_EQ(planned->modules[1].parameters.at("frames"),
            "head 3 robot neck.pose 1; gripper 100 robot seeker.pose 3; "
            "finger 101 gripper neck.pose 1");
  EXPECT_EQ(values_of(planned->modules[0], "--out"),
            (std::vector<std::string>{"pose=shm:t.neck.pose?readers=1&stay=1"}));
  EXPECT_EQ(values_of(planned->modules[1], "--in"),
            (std::vector<std::string>{"frames=shm:t.neck.pose?wait=60&keep=1024"}));
}

TEST(Frames, ALinkOrAParameterOfTheFileStandsInTheirPlace) {
  EXPECT_EQ(links_of(plan(kMoved + link_text("unix:poses", "seeker.frames"))),
            "unix:poses seeker.frames all\n");
  EXPECT_EQ(links_of(plan(std::string(kMoved) + "[modules.other]\nprogram = \"seeker\"\n"
                                                "parameters.frames = \"\"\n")),
            "neck.pose seeker.frames 1024\n");
}

TEST(Frames, PosesMakeNoLoop) {
  EXPECT_EQ(links_of(plan(kMoved + link_text("seeker.command", "neck.command"))),
            "seeker.command neck.command all\nneck.pose seeker.frames 1024\n");
}

TEST(Frames, WhatMovesThemSendsPoses) {
  EXPECT_EQ(wrong("[modules.source]\n[modules.seeker]\n[frames.head]\nparent = \"robot\"\n"
                  "moved_by = \"source.left\"\n"),
            "g.toml:6: source.left sends map of 1 x f32 in coordinate system left_image (7), "
            "seeker.frames takes "
            "transformation 4 x 4 of 1 x f64");
  EXPECT_EQ(
      wrong("[modules.source]\n[frames.head]\nparent = \"robot\"\n"
            "moved_by = \"source.left\"\n"),
      "g.toml:5: source.left sends map of 1 x f32 in coordinate system left_image (7), not a pose, "
      "transformation 4 x 4");
  EXPECT_EQ(wrong("[modules.neck]\n[frames.a]\nparent = \"root\"\nmoved_by = \"neck.pose\"\n"
                  "[frames.b]\nparent = \"a\"\nmoved_by = \"neck.pose\"\n"),
            "g.toml:8: neck.pose moves a and b, so they and their parents need a \"coord\"");
}

TEST(Frames, AnglesAreRollPitchAndYawAboutAxesThatStandStill) {
  auto rotation = [](const std::string& angles) {
    Problems problems("g.toml");
    auto graph = parse_graph(
        "version = 1\n[modules.a]\n[frames.a]\nparent = \"b\"\nrotation = " + angles, {}, problems);
    EXPECT_TRUE(problems.empty());
    return graph.frames.at(0).rotation;
  };
  constexpr double kHalf = 0.70710678118654752;  // sin(90° / 2)
  constexpr double kTolerance = 1e-15;           // rounding of numbers below 1
  auto expect = [&](const std::string& angles, const std::array<double, 4>& wanted) {
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(rotation(angles)[i], wanted[i], kTolerance) << angles << " " << i;
  };
  expect("[90, 0, 0]", {kHalf, 0, 0, kHalf});
  expect("[0, 90, 0]", {0, kHalf, 0, kHalf});
  expect("[0, 0, 90]", {0, 0, kHalf, kHalf});
  // Rz(90°) Rx(90°) = (0, 0, s, s) (s, 0, 0, s) as quaternions, s² = 1/2.
  expect("[90, 0, 90]", {0.5, 0.5, 0.5, 0.5});
  expect("[90, 90, 0]", {0.5, 0.5, -0.5, 0.5});  // Ry(90°) Rx(90°)
}

TEST(Frames, ErrorsNameTheLineAndWhatWouldBeRight) {
  auto expect = [](const std::string& rest, const std::string& wanted) {
    EXPECT_EQ(wrong("[modules.source]\n[frames.a]\n" + rest), "g.toml:" + wanted);
  };
  const std::string top = "parent = \"root\"\n";
  expect("", "3: \"parent\" is missing in frame a");
  expect("parent = \"a\"\n", "4: frames form a circle: a in a");
  expect("parent = \"b\"\n[frames.b]\nparent = \"a\"\n", "4: frames form a circle: a in b in a");
  expect(top + "[frames.b]\nparent = \"aa\"\n",
         "6: no frame \"aa\", did you mean \"a\"?; the root is root");
  expect(top + "[frames.b]\nparent = \"other\"\n", "6: no frame \"other\"; the root is root");
  expect(top + "coord = 3\n", "5: coordinate system 3 is head");
  expect(top + "[frames.head]\nparent = \"root\"\ncoord = 200\n", "7: frame head has the number 3");
  expect(top + "coord = 200\n[frames.b]\nparent = \"a\"\ncoord = 200\n",
         "8: coordinate system 200 is a");
  expect(top + "moved_by = \"source.lft\"\n",
         "5: module source has no output \"lft\", did you mean \"left\"?");
  expect(top + "moved_by = \"sourc.left\"\n", "5: no module \"sourc\", did you mean \"source\"?");
  expect(top + "moved_by = \"source.left\"\ntranslation = [1, 2, 3]\n",
         "6: a frame with \"moved_by\" has no \"translation\"");
  expect(top + "translation = [1, 2]\n", "5: \"translation\" must be a list of 3 numbers");
  expect(top + "rotation = [1, 2, nan]\n", "5: \"rotation\" must be a list of 3 numbers");
}

}  // namespace
}  // namespace hc
