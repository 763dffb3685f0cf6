// SPDX-License-Identifier: Apache-2.0
#include "trace_paths.h"

#include <gtest/gtest.h>

#include <limits>

namespace tool {
namespace {

using hc::TraceEvent;
using What = TraceEvent::What;
using namespace std::chrono_literals;

constexpr hc::Time kSeen = hc::unix_time(1000), kLater = hc::unix_time(2000);  // of messages

/// Events of one module for messages of one time; moments are relative to it.
class Events {
 public:
  explicit Events(std::vector<TraceEvent>& events, hc::Time seen) : events_(events), seen_(seen) {}
  Events& took(const std::string& port, int src, std::int64_t at) {
    return add(What::Took, port, src, at);
  }
  Events& handled(const std::string& port, int src, std::int64_t begin, std::int64_t end) {
    add(What::Began, port, src, begin);
    return add(What::Ended, port, src, end);
  }
  Events& began(const std::string& port, int src, std::int64_t at) {
    return add(What::Began, port, src, at);
  }
  Events& ended(const std::string& port, int src, std::int64_t at) {
    return add(What::Ended, port, src, at);
  }
  Events& sent(const std::string& port, int src, std::int64_t at) {
    return add(What::Sent, port, src, at);
  }
  /// A timer handler.
  Events& busy(std::int64_t begin, std::int64_t end) {
    events_.push_back({What::Began, "", 0, 0, {}, seen_ + nanoseconds(begin)});
    events_.push_back({What::Ended, "", 0, 0, {}, seen_ + nanoseconds(end)});
    return *this;
  }

 private:
  Events& add(What what, const std::string& port, int src, std::int64_t at) {
    events_.push_back({what, port, src, 5, seen_, seen_ + nanoseconds(at)});
    return *this;
  }
  std::vector<TraceEvent>& events_;
  hc::Time seen_;
};

struct Chain : ::testing::Test {
  Traced traced;
  Events of(const std::string& module, hc::Time seen = kSeen) {
    return Events(traced.events[module], seen);
  }
  /// Takes an image and sends a position.
  void blob_follows_eye(hc::Time seen = kSeen) {
    of("eye", seen).sent("left", 1, 100);
    of("blob", seen).took("image", 1, 130).began("image", 1, 135).sent("target", 2, 180);
    of("blob", seen).ended("image", 1, 190);
  }
  /// The only path to a port.
  [[nodiscard]] MessagePath path_to(const std::string& port) const {
    const auto paths = find_paths(traced, port);
    EXPECT_EQ(paths.size(), 1U);
    return paths.empty() ? MessagePath() : paths[0];
  }
};

/// "module.out 30/0/100" …: link, waiting and processing of each step.
std::string words(const MessagePath& path) {
  std::string text;
  for (const auto& step : path.steps)
    text += (text.empty() ? "" : ", ") + step.text() + " " + std::to_string(step.link.count()) +
            "/" + std::to_string(step.waiting.count()) + "/" +
            std::to_string(step.processing.count()) + (step.is_outside ? " outside" : "");
  return text;
}

nanoseconds sum(const MessagePath& path) {
  nanoseconds all{0};
  for (const auto& step : path.steps) all += step.link + step.waiting + step.processing;
  return all;
}

TEST_F(Chain, StepsAddUpToTheAge) {
  blob_follows_eye();
  of("neck").busy(150, 200).took("command", 2, 203).handled("command", 2, 204, 210);
  const auto path = path_to("neck.command");
  EXPECT_EQ(words(path), "eye.left 0/0/100, blob: image → target 30/5/45, neck.command 3/21/6");
  EXPECT_EQ(path.age, 203ns);
  EXPECT_TRUE(path.is_critical);
  EXPECT_EQ(sum(path) - 7ns, path.age);  // without the time after its arrival
}

TEST_F(Chain, OfAnOutputEndsWithItsSending) {
  blob_follows_eye();
  const auto path = path_to("blob.target");
  EXPECT_EQ(words(path), "eye.left 0/0/100, blob: image → target 30/5/45");
  EXPECT_EQ(path.age, 180ns);
  EXPECT_EQ(sum(path), path.age);
}

TEST_F(Chain, OfTwoInputsTheLaterOneIsCritical) {
  of("eyes").sent("left", 1, 10).sent("right", 2, 20);
  of("depth").took("left", 1, 15).took("right", 2, 40);
  of("depth").began("left", 1, 50).began("right", 2, 50).sent("depth", 3, 70);
  of("depth").ended("left", 1, 80).ended("right", 2, 80);
  const auto paths = find_paths(traced, "depth.depth");
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_EQ(words(paths[0]), "eyes.left 0/0/10, depth: left → depth 5/35/20");
  EXPECT_FALSE(paths[0].is_critical);
  EXPECT_EQ(words(paths[1]), "eyes.right 0/0/20, depth: right → depth 20/10/20");
  EXPECT_TRUE(paths[1].is_critical);
  const auto summaries = summarise(paths);
  ASSERT_EQ(summaries.size(), 2U);
  EXPECT_EQ(summaries[0].steps[0].text(), "eyes.right");
  EXPECT_EQ(summaries[0].critical, 1U);
  EXPECT_EQ(summaries[0].durations[1].link.median, 20ns);
}

TEST_F(Chain, WhatATimerSendsHasWaitedForIt) {
  of("eye").sent("left", 1, 10);
  of("gaze").took("target", 1, 20).handled("target", 1, 20, 30).busy(35, 36);
  of("gaze").began("", 0, 50).sent("command", 2, 52).ended("", 0, 53);
  EXPECT_EQ(words(path_to("gaze.command")), "eye.left 0/0/10, gaze: target → command 10/19/13");
}

TEST_F(Chain, OfAControllersNewTimeThePathGoesOnAtWhatItHandledLast) {
  of("eye").sent("left", 1, 100);
  of("gaze").took("target", 1, 120).handled("target", 1, 130, 140);
  const auto again = kSeen + 300ns;  // a newer pose, and a command
  of("neck", again).sent("pose", 3, 1);
  of("gaze", again).took("pose", 3, 5).handled("pose", 3, 6, 7);
  of("gaze", again + 20ns).sent("command", 2, 1);
  of("neck", again + 20ns).took("command", 2, 11);
  const auto paths = find_paths(traced, "neck.command");
  ASSERT_EQ(paths.size(), 2U);
  EXPECT_EQ(words(paths[0]), "neck.pose 0/0/1, gaze: pose → command 4/15/1, neck.command 10/0/0");
  EXPECT_FALSE(paths[0].is_critical);
  EXPECT_EQ(paths[0].total, 31ns);
  EXPECT_EQ(words(paths[1]),
            "eye.left 0/0/100, gaze: target → command 20/190/11, neck.command 10/0/0");
  EXPECT_TRUE(paths[1].steps[1].renews_time);
  EXPECT_TRUE(paths[1].is_critical);  // sensed first
  EXPECT_EQ(paths[1].age, 11ns);
  EXPECT_EQ(paths[1].total, 331ns);
}

TEST_F(Chain, ASensorBehindTheNextModuleBegins) {
  of("eye").took("gaze", 9, 5).handled("gaze", 9, 5, 6);
  blob_follows_eye(kLater);
  of("gaze", kLater).took("target", 2, 190);
  EXPECT_EQ(words(path_to("gaze.target")),
            "eye.left 0/0/100, blob: image → target 30/5/45, gaze.target 10/0/0");
}

TEST_F(Chain, ASensorThatFeedsTheModuleOfAnOutputBegins) {
  of("eye").took("gaze", 9, 5).handled("gaze", 9, 5, 6);
  of("neck").sent("pose", 9, 1);
  blob_follows_eye(kLater);
  EXPECT_EQ(words(path_to("blob.target")), "eye.left 0/0/100, blob: image → target 30/5/45");
}

TEST_F(Chain, OfANewTimeTheLastMessageAtEachInputCountsForASecond) {
  auto& events = traced.events["gaze"];
  auto handle = [&](const std::string& port, int seq, nanoseconds after) {
    const hc::Time at(after);
    events.push_back({What::Took, port, 1, seq, at, at});
    events.push_back({What::Began, port, 1, seq, at, at});
    events.push_back({What::Ended, port, 1, seq, at, at});
  };
  handle("old", 1, 1s);
  handle("new", 2, 2s - 100ns);
  handle("new", 3, 2s);
  const hc::Time sent(2s + 1ns);
  events.push_back({What::Sent, "command", 2, 0, sent, sent});
  handle("new", 4, 2s + 2ns);
  for (const auto& event : events)
    if (event.what == What::Took)
      traced.events["eye"].push_back({What::Sent, "out", 1, event.seq, event.time, event.moment});
  EXPECT_EQ(words(path_to("gaze.command")), "eye.out 0/0/0, gaze: new → command 0/1/0");
}

TEST_F(Chain, GoesThroughARouterThatForwards) {
  of("joystick").sent("stick", 1, 10);
  of("router").took("in", 1, 15).began("in", 1, 16).sent("out", 1, 18).ended("in", 1, 19);
  of("neck").took("command", 1, 25).handled("command", 1, 25, 30);
  EXPECT_EQ(words(path_to("neck.command")),
            "joystick.stick 0/0/10, router: in → out 5/1/2, neck.command 7/0/5");
}

TEST_F(Chain, AModuleWithoutATraceIsOneStep) {
  of("eye").sent("left", 1, 10);
  of("neck").took("command", 7, 100).handled("command", 7, 100, 101);
  traced.links = {{"eye.left", "finder.image"}, {"finder.target", "neck.command"}};
  EXPECT_EQ(words(path_to("neck.command")),
            "eye.left 0/0/10, finder: image → target 0/0/90 outside, neck.command 0/0/1");
  traced.links = {{"tcp:host:1", "neck.command"}};
  EXPECT_EQ(words(path_to("neck.command")), "tcp:host:1 0/0/100 outside, neck.command 0/0/1");
}

TEST_F(Chain, WhatWasSentBeforeTheTraceBeganIsLeftOut) {
  of("eye");
  of("blob").took("image", 1, 130).handled("image", 1, 135, 140);
  traced.links = {{"eye.left", "blob.image"}};
  EXPECT_TRUE(find_paths(traced, "blob.image").empty());
}

TEST_F(Chain, BranchesAreBounded) {
  // Each of eight modules has two inputs from the one before it: 256 paths.
  of("m0").sent("a", 1, 0).sent("b", 2, 0);
  for (int i = 1; i <= 8; ++i) {
    auto events = of("m" + std::to_string(i));
    const int at = 10 * i, src = 2 * i;
    events.took("a", src - 1, at).took("b", src, at + 1);
    events.began("a", src - 1, at + 2).began("b", src, at + 2);
    events.sent("a", src + 1, at + 3).sent("b", src + 2, at + 3);
    events.ended("a", src - 1, at + 4).ended("b", src, at + 4);
  }
  EXPECT_EQ(find_paths(traced, "m8.a").size(), kMostPaths);
}

TEST_F(Chain, MomentsThatGoBackCountForNothing) {
  constexpr std::int64_t kEnd = std::numeric_limits<std::int64_t>::max() - 1000;
  of("eye").sent("left", 1, 100);
  auto blob = of("blob");
  for (int i = 0; i < 3; ++i) blob.busy(200, kEnd);  // the same period
  blob.took("image", 1, kEnd).handled("image", 1, 300, 200).sent("position", 2, kEnd);
  of("gaze").took("target", 2, kEnd).handled("target", 2, 100, kEnd);
  for (const auto& path : find_paths(traced, "gaze.target")) {
    nanoseconds sum{0};
    for (const auto& step : path.steps) {
      EXPECT_GE(step.waiting.count(), 0);
      EXPECT_GE(step.link.count(), 0);
      sum += step.waiting + step.link + step.processing;
    }
    EXPECT_EQ(sum, path.total);
  }
}

TEST(Spread, IsOfAllDurations) {
  EXPECT_EQ(spread_of({}).median, 0ns);
  std::vector<nanoseconds> all;
  for (int i = 0; i <= 200; ++i) all.emplace_back(200 - i);
  EXPECT_EQ(spread_of(all).median, 100ns);
  EXPECT_EQ(spread_of(all).p99, 198ns);
}

}  // namespace
}  // namespace tool
