// SPDX-License-Identifier: Apache-2.0
#include <graph/run/change.h>

#include <gtest/gtest.h>

namespace hc::internal {
namespace {

using Texts = std::vector<std::string>;

Texts texts(const std::vector<ModuleCommand>& commands) {
  Texts texts;
  for (const auto& command : commands) texts.push_back(text(command));
  return texts;
}

class ChangeTest : public ::testing::Test {
 protected:
  ChangeTest() {
    before_.program = "camera";
    before_.control_uri = "unix-listen:@t.camera.control";
    before_.parameters = {{"rate", "30"}, {"source", "0"}};
    before_.known["source"].options.fixed = true;
    before_.ends = {{false, "left", "shm:t.camera.left?readers=1&stay=1", ""},
                    {true, "gaze", "unix:@t.eyes.gaze.camera.gaze?reconnect=86400", ""}};
    after_ = before_;
  }
  ModuleChange change() { return change_between(before_, after_); }

  PlannedModule before_, after_;
};

TEST_F(ChangeTest, WhatStaysAsItIsNeedsNoCommand) {
  EXPECT_TRUE(change().is_empty());
  after_.restart = Restart::Never;  // does not concern the process
  EXPECT_TRUE(change().is_empty());
}

TEST_F(ChangeTest, MoreReadersAreNoOtherLink) {
  after_.ends[0].uri = "shm:t.camera.left?readers=2&stay=1";
  EXPECT_TRUE(change().is_empty());
}

TEST_F(ChangeTest, AParameterIsSet) {
  after_.parameters["rate"] = "10";
  EXPECT_EQ(texts(change().outputs), Texts{"set rate=10"});
  EXPECT_FALSE(change().needs_restart);
}

TEST_F(ChangeTest, WhatNoCommandChangesNeedsARestart) {
  after_.parameters["source"] = "1";
  EXPECT_TRUE(change().needs_restart) << "fixed";
  after_ = before_;
  after_.parameters.erase("rate");
  EXPECT_TRUE(change().needs_restart) << "given no more";
  after_ = before_;
  after_.program = "other";
  EXPECT_TRUE(change().needs_restart);
  after_ = before_;
  after_.options = {"--address", "left=7"};
  EXPECT_TRUE(change().needs_restart);
  after_ = before_;
  before_.control_uri.clear();
  after_.control_uri.clear();
  EXPECT_TRUE(change().is_empty());
  after_.parameters["rate"] = "10";
  EXPECT_TRUE(change().needs_restart) << "does not listen";
}

TEST_F(ChangeTest, LinksComeAndGo) {
  after_.ends = {{false, "left", "shm:t.camera.left.view.image?readers=1&rate=3", ""},
                 {false, "right", "shm:t.camera.right?readers=1&stay=1", "to=21"}};
  auto made = change();
  EXPECT_EQ(texts(made.unlinks),
            (Texts{"unlink out left=shm:t.camera.left?readers=1&stay=1",
                   "unlink in gaze=unix:@t.eyes.gaze.camera.gaze?reconnect=86400"}));
  EXPECT_EQ(texts(made.outputs),
            (Texts{"link out left=shm:t.camera.left.view.image?readers=1&rate=3",
                   "link out right=shm:t.camera.right?readers=1&stay=1",
                   "route right=shm:t.camera.right?readers=1&stay=1 to=21"}));
  EXPECT_TRUE(made.inputs.empty());
}

TEST_F(ChangeTest, ARouteAloneChanges) {
  after_.ends[0].route = "to=5,-1";
  EXPECT_EQ(texts(change().outputs),
            Texts{"route left=shm:t.camera.left?readers=1&stay=1 to=5,-1"});
}

}  // namespace
}  // namespace hc::internal
