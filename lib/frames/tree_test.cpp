// SPDX-License-Identifier: Apache-2.0
#include <frames/tree.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <optional>

#include "random_motion_test.h"

namespace hc::frames {
namespace {

using namespace std::chrono_literals;

constexpr Time kTime(1'763'683'200s);  // November 2025

Eigen::Isometry3d shift(double x, double y = 0, double z = 0) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// World, robot, moving head, eyes.
Tree head_tree() {
  Tree tree = Tree::standard();
  EXPECT_TRUE(tree.fix("world", "robot", shift(1)));
  EXPECT_TRUE(tree.join("robot", "head"));
  EXPECT_TRUE(tree.fix("head", "left_eye", shift(0, 0.1)));
  EXPECT_TRUE(tree.fix("head", "right_eye", shift(0, -0.1)));
  return tree;
}

template <typename T>
std::string refusal(const Result<T>& result) {
  return result ? "" : result.error().text();
}

TEST(Tree, FollowsTheHeadAtTheTimeOfAnImage) {
  Tree tree = head_tree();
  for (int i = 0; i <= 2; ++i) {
    Eigen::Isometry3d T_robot_head(rotation(0, 0, i * 0.2));
    ASSERT_EQ(*tree.feed("robot", "head", kTime + i * 10ms, T_robot_head), Fed::Added);
  }
  auto T_world_left_eye = tree.lookup("world", "left_eye", kTime + 15ms);
  ASSERT_TRUE(T_world_left_eye) << T_world_left_eye.error().text();
  Eigen::Vector3d p_world = *T_world_left_eye * Eigen::Vector3d(2, 0, 0);
  Eigen::Vector3d expected(1 + 2 * std::cos(0.3) - 0.1 * std::sin(0.3),
                           2 * std::sin(0.3) + 0.1 * std::cos(0.3), 0);
  EXPECT_LT((p_world - expected).norm(), 1e-12) << "m";
  auto by_number = tree.lookup(1, 4, kTime + 15ms);
  EXPECT_EQ(by_number->matrix(), T_world_left_eye->matrix());
}

TEST(Tree, AsksNothingThatIsNotOnTheWay) {
  Tree tree = head_tree();  // without a pose of the head
  auto T_right_left = tree.lookup("right_eye", "left_eye", {});
  ASSERT_TRUE(T_right_left);
  EXPECT_TRUE(T_right_left->isApprox(shift(0, 0.2)));
  EXPECT_EQ(*tree.known("right_eye", "left_eye"), TimeSpan());
  EXPECT_TRUE(tree.lookup("head", "head", {})->isApprox(shift(0)));
}

TEST(Tree, ExtrapolatesNothing) {
  Tree tree = head_tree();
  EXPECT_EQ(refusal(tree.lookup("world", "left_eye", kTime)),
            "NotFound: frames: head in robot has no pose yet");
  ASSERT_TRUE(tree.feed("robot", "head", kTime, shift(0)));
  EXPECT_TRUE(tree.lookup("world", "left_eye", kTime)) << "one pose is known at its own time";
  ASSERT_TRUE(tree.feed("robot", "head", kTime + 1ms, shift(0)));
  const std::string known =
      "NotFound: frames: head in robot is known from 1763683200000000000 to 1763683200001000000 ns";
  EXPECT_EQ(refusal(tree.lookup("world", "left_eye", kTime + 13300us)),
            known + ", asked for 1763683200013300000 ns: 12.3 ms too late");
  EXPECT_EQ(refusal(tree.lookup("left_eye", "world", kTime - 999ns)),
            known + ", asked for 1763683199999999001 ns: 999 ns too early");
  EXPECT_EQ(refusal(tree.lookup("world", "head", {})),
            known + ", asked for time 0, which means unknown");
  for (auto [away, text] : std::map<std::int64_t, std::string>{{1, "1 ns"},
                                                               {1000, "1.0 µs"},
                                                               {999'949, "999.9 µs"},
                                                               {999'950, "1.0 ms"},
                                                               {999'999'999, "1.0 s"},
                                                               {86'400'000'000'000, "86400.0 s"}}) {
    EXPECT_TRUE(refusal(tree.lookup("world", "head", kTime - std::chrono::nanoseconds(away)))
                    .ends_with(text + " too early"));
  }
  for (auto time : {Time::min(), Time::max()}) EXPECT_FALSE(tree.lookup("world", "head", time));
}

TEST(Tree, KnownIsWhenAllJointsAre) {
  Tree tree = head_tree();
  ASSERT_TRUE(tree.join("head", "supervisor"));
  EXPECT_EQ(refusal(tree.known("world", "supervisor")),
            "NotFound: frames: supervisor in head has no pose yet");
  for (int time : {10, 20, 30}) ASSERT_TRUE(tree.feed("robot", "head", unix_time(time), shift(0)));
  for (int time : {40, 50}) ASSERT_TRUE(tree.feed("head", "supervisor", unix_time(time), shift(0)));
  EXPECT_EQ(refusal(tree.known("supervisor", "world")),
            "NotFound: frames: head in robot is known to 30 ns and supervisor in head from 40 ns: "
            "no common time");
  ASSERT_TRUE(tree.feed("head", "supervisor", unix_time(15), shift(0)));
  EXPECT_EQ(*tree.known("supervisor", "world"), (TimeSpan{unix_time(15), unix_time(30)}));
  EXPECT_EQ(*tree.known("world", "left_eye"), (TimeSpan{unix_time(10), unix_time(30)}));
  EXPECT_TRUE(tree.lookup("supervisor", "world", unix_time(30)));
  EXPECT_FALSE(tree.lookup("supervisor", "world", unix_time(31)));
  tree.forget();
  EXPECT_FALSE(tree.known("world", "head"));
  EXPECT_EQ(*tree.feed("robot", "head", unix_time(5), shift(0)), Fed::Added);
}

TEST(Tree, BridgesNoGap) {
  Tree tree = head_tree();
  for (Time time : {kTime, kTime + 1s, kTime + 2s + 1ns})
    ASSERT_TRUE(
        tree.feed("robot", "head", time, shift(static_cast<double>((time - kTime).count()))));
  EXPECT_TRUE(tree.lookup("world", "left_eye", kTime + 500ms)) << "1 s is bridged";
  EXPECT_EQ(refusal(tree.lookup("world", "left_eye", kTime + 1s + 1ns)),
            "NotFound: frames: head in robot is not known between 1763683201000000000 and "
            "1763683202000000001 ns, asked for 1763683201000000001 ns: a gap of 1.0 s");
  EXPECT_EQ(*tree.known("world", "left_eye"), (TimeSpan{kTime + 2s + 1ns, kTime + 2s + 1ns}));
  EXPECT_EQ(refusal(tree.join("world", "supervisor", {.gap = std::chrono::nanoseconds(0)})),
            "Invalid: frames: a gap of 0 ns joins nothing");
}

TEST(Tree, KnownIsTheLatestSpanWithoutAGapOfAnyJoint) {
  Tree tree = head_tree();
  ASSERT_TRUE(tree.join("head", "supervisor", {.gap = std::chrono::nanoseconds(10)}));
  for (int time : {12, 40, 60}) ASSERT_TRUE(tree.feed("robot", "head", unix_time(time), shift(0)));
  for (int time : {10, 20, 25, 70})
    ASSERT_TRUE(tree.feed("head", "supervisor", unix_time(time), shift(0)));
  // No pose of the supervisor is known for the last 60, back to 25.
  EXPECT_EQ(*tree.known("world", "supervisor"), (TimeSpan{unix_time(12), unix_time(25)}));
  Tree apart = Tree::standard();
  ASSERT_TRUE(apart.join("robot", "head", {.gap = std::chrono::nanoseconds(10)}));
  ASSERT_TRUE(apart.join("head", "supervisor", {.gap = std::chrono::nanoseconds(10)}));
  for (int time : {10, 30}) ASSERT_TRUE(apart.feed("robot", "head", unix_time(time), shift(0)));
  for (int time : {20, 25})
    ASSERT_TRUE(apart.feed("head", "supervisor", unix_time(time), shift(0)));
  EXPECT_EQ(refusal(apart.known("robot", "supervisor")),
            "NotFound: frames: between 20 and 25 ns some joint always has a gap");
}

TEST(Tree, AFrameMayHaveANameAlone) {
  Tree tree = Tree::standard();
  ASSERT_TRUE(tree.add("chip"));
  ASSERT_TRUE(tree.fix("head", "chip", shift(3)));
  EXPECT_TRUE(tree.lookup(3, "chip", {})->isApprox(shift(3)));
  EXPECT_EQ(refusal(tree.add("chip")), "Invalid: frames: there is a frame chip already");
  EXPECT_EQ(refusal(tree.add("")), "Invalid: frames: a frame has no name");
  EXPECT_EQ(refusal(tree.add("a b")), "Invalid: frames: a frame has a name with a blank");
}

TEST(Tree, NamesFramesThatThereAreNot) {
  Tree tree = head_tree();
  EXPECT_EQ(refusal(tree.lookup("world", "left_eey", kTime)),
            "NotFound: frames: no frame \"left_eey\", did you mean \"left_eye\"?");
  EXPECT_EQ(refusal(tree.known("a\nb", "world")),
            "NotFound: frames: no frame \"a\\nb\"; known: cyclopean_eye, head, left_eye, "
            "right_eye, robot, supervisor, world");
  EXPECT_EQ(refusal(tree.lookup(77, "world", kTime)), "NotFound: frames: no frame 77");
  EXPECT_EQ(refusal(tree.fix("world", "hed", shift(0))),
            "NotFound: frames: no frame \"hed\", did you mean \"head\"?");
  EXPECT_EQ(refusal(tree.feed("robot", 0, kTime, shift(0))), "NotFound: frames: no frame 0");
  EXPECT_EQ(refusal(tree.lookup("left_eye", "supervisor", kTime)),
            "NotFound: frames: left_eye and supervisor are not joined: above them are world and "
            "supervisor");
}

TEST(Tree, AChainIsTheFramesBetween) {
  Tree tree = head_tree();
  EXPECT_EQ(*tree.chain("right_eye", "world"),
            (std::vector<std::string>{"world", "robot", "head", "right_eye"}));
  EXPECT_EQ(*tree.chain("left_eye", "right_eye"),
            (std::vector<std::string>{"right_eye", "head", "left_eye"}));
  EXPECT_FALSE(tree.chain("world", "supervisor"));
}

TEST(Tree, WhatIsNotFedIsWhereItsParentIsAndWhatIsSilentWhereItWas) {
  Tree tree;
  ASSERT_TRUE(tree.add("base"));
  ASSERT_TRUE(tree.add("arm"));
  ASSERT_TRUE(tree.join("base", "arm"));
  EXPECT_TRUE(tree.nearest("base", "arm", kTime)->isApprox(shift(0)));
  EXPECT_TRUE(tree.is_ahead("base", "arm", kTime));
  ASSERT_TRUE(tree.feed("base", "arm", kTime, shift(2)));
  EXPECT_TRUE(tree.nearest("base", "arm", kTime + 1ns)->isApprox(shift(2)));
  EXPECT_FALSE(tree.is_ahead("base", "arm", kTime));
  EXPECT_TRUE(tree.is_ahead("arm", "base", kTime + 1ns));
  EXPECT_FALSE(tree.nearest("base", "leg", kTime));
}

TEST(Tree, MayHoldSeveral) {
  Tree tree = head_tree();
  for (const char* name : {"map", "landmark"}) ASSERT_TRUE(tree.add(name));
  ASSERT_TRUE(tree.fix("map", "landmark", shift(1)));
  EXPECT_TRUE(tree.nearest("map", "landmark", kTime));
  EXPECT_FALSE(tree.nearest("world", "landmark", kTime));
}

TEST(Tree, StaysATree) {
  Tree tree = head_tree();
  EXPECT_EQ(
      refusal(tree.fix("cyclopean_eye", "left_eye", shift(0))),
      "Invalid: frames: left_eye in cyclopean_eye would be a second parent: there is left_eye in "
      "head");
  EXPECT_EQ(refusal(tree.fix("left_eye", "world", shift(0))),
            "Invalid: frames: world in left_eye would close a cycle");
  EXPECT_EQ(refusal(tree.join("supervisor", "supervisor")),
            "Invalid: frames: supervisor in supervisor would close a cycle");
  EXPECT_EQ(refusal(tree.fix("robot", "head", shift(0))),
            "Invalid: frames: head in robot is given twice");
  EXPECT_EQ(refusal(tree.add(3, "face")), "Invalid: frames: frame 3 is head already");
  EXPECT_EQ(refusal(tree.add(100, "head")), "Invalid: frames: there is a frame head already");
  EXPECT_EQ(refusal(tree.add(100, "")), "Invalid: frames: frame 100 has no name");
  for (const char* name : {"a b", "a\n", "\t"})
    EXPECT_EQ(refusal(tree.add(100, name)), "Invalid: frames: frame 100 has a name with a blank");
  for (int number : {-1, 0, 1000}) EXPECT_FALSE(tree.add(number, "board"));
  EXPECT_TRUE(tree.add(999, "board"));
}

TEST(Tree, RefusesWhatCannotBeFed) {
  Tree tree = head_tree();
  EXPECT_EQ(refusal(tree.feed("head", "robot", kTime, shift(0))),
            "Invalid: frames: robot in head is fed, but not joined");
  EXPECT_EQ(refusal(tree.feed("world", "robot", kTime, shift(0))),
            "Invalid: frames: robot in world is fed, but fixed");
  for (Time time : {unix_time(0), unix_time(-1)})
    EXPECT_EQ(refusal(tree.feed("robot", "head", time, shift(0))),
              "Malformed: frames: head in robot is fed without a time");
  Eigen::Isometry3d wrong = shift(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(tree.feed("robot", "head", kTime, wrong));
  EXPECT_FALSE(tree.fix("world", "supervisor", wrong));
  EXPECT_FALSE(tree.known("world", "head")) << "nothing changed";
  EXPECT_FALSE(tree.known("world", "supervisor"));
  EXPECT_EQ(refusal(tree.join("world", "supervisor", {.poses = 0})),
            "Invalid: frames: a memory of 0 poses over 10000000000 ns stores nothing");
  EXPECT_FALSE(tree.join("world", "supervisor", {.span = std::chrono::nanoseconds(0)}));
  EXPECT_TRUE(tree.join("world", "supervisor", {.poses = 1}));
}

/// The expected result of a tree, from 4 × 4 matrices, general inverses and a search through an
/// undirected graph.
struct Reference {
  struct Edge {
    int parent, child;
    std::map<Time, Eigen::Matrix4d> poses;  // empty: fixed
    Eigen::Matrix4d fixed;
    std::chrono::nanoseconds gap{0};

    [[nodiscard]] std::optional<Eigen::Matrix4d> at(Time time) const {
      if (poses.empty()) return fixed;
      auto next = poses.lower_bound(time);
      if (next == poses.end()) return std::nullopt;
      if (next->first == time) return next->second;
      if (next == poses.begin()) return std::nullopt;
      auto before = std::prev(next);
      if (next->first - before->first > gap) return std::nullopt;
      return interpolated(before->second, next->second,
                          seconds(time - before->first) / seconds(next->first - before->first));
    }
  };
  std::vector<Edge> edges;

  /// T_target_source, searched from `at`, which was reached from `from`.
  [[nodiscard]] std::optional<Eigen::Matrix4d> find(int target, int at, int from, Time time) const {
    if (target == at) return Eigen::Matrix4d::Identity();
    for (const Edge& edge : edges) {
      int next = edge.child == at ? edge.parent : edge.parent == at ? edge.child : from;
      if (next == from) continue;
      auto rest = find(target, next, at, time), step = edge.at(time);
      if (!rest || !step) continue;
      return *rest * (next == edge.parent ? *step : Eigen::Matrix4d(step->inverse()));
    }
    return std::nullopt;
  }
};

TEST(Tree, IsWhatBruteForceFinds) {
  RandomMotion random(7);
  int found = 0, missed = 0;
  for (int round = 0; round < 60; ++round) {
    const int frames = random.whole(2, 14);
    Tree tree;
    Reference reference;
    for (int i = 1; i <= frames; ++i) ASSERT_TRUE(tree.add(i, "frame_" + std::to_string(i)));
    for (int child = 2; child <= frames; ++child) {
      int parent = random.whole(0, child - 1);  // 0: this is the root of another tree
      if (parent == 0) continue;
      Reference::Edge edge{parent, child, {}, random.transformation().matrix()};
      if (random.whole(0, 1) == 0) {
        ASSERT_TRUE(tree.fix(parent, child, Eigen::Isometry3d(edge.fixed)));
      } else {
        edge.gap = std::chrono::nanoseconds(random.whole(1, 100));
        ASSERT_TRUE(tree.join(parent, child, {.gap = edge.gap}));
        for (int i = random.whole(1, 12); i > 0; --i) {
          Eigen::Isometry3d pose = random.transformation();
          const Time time = kTime + std::chrono::nanoseconds(random.whole(0, 100));
          edge.poses[time] = pose.matrix();
          ASSERT_TRUE(tree.feed(parent, child, time, pose));
        }
      }
      reference.edges.push_back(std::move(edge));
    }
    for (int i = 0; i < 200; ++i) {
      int target = random.whole(1, frames), source = random.whole(1, frames);
      const Time time = kTime + std::chrono::nanoseconds(random.whole(0, 100));
      auto got = tree.lookup(target, source, time);
      auto expected = reference.find(target, source, 0, time);
      ASSERT_EQ(got.has_value(), expected.has_value()) << refusal(got);
      auto span = tree.known(target, source);
      if (span && span->first <= time) {
        EXPECT_EQ(time <= span->last, got.has_value());
      }
      if (got) {
        EXPECT_TRUE(span && time <= span->last);
      }
      (got ? found : missed)++;
      if (!got) continue;
      EXPECT_LT((got->matrix() - *expected).norm(), 1e-8);
      // The reverse is the inverse, and an intermediate frame changes nothing.
      EXPECT_LT(((*tree.lookup(source, target, time) * *got).matrix() - Eigen::Matrix4d::Identity())
                    .norm(),
                1e-12);
      int stop = random.whole(1, frames);
      auto first = tree.lookup(stop, source, time), second = tree.lookup(target, stop, time);
      if (first && second) {
        EXPECT_LT(((*second * *first).matrix() - got->matrix()).norm(), 1e-12);
      }
    }
  }
  EXPECT_GT(found, 2000);
  EXPECT_GT(missed, 2000);
}

}  // namespace
}  // namespace hc::frames
