// SPDX-License-Identifier: Apache-2.0
#include <frames/module_frames.h>

#include <gtest/gtest.h>

#include <vector>

#include <hc/base/clock.h>

namespace hc {
namespace {

using namespace std::chrono_literals;

constexpr Time kStart(1'700'000'000s);

/// The default head, which turns to the left by 1 rad a second.
class DefaultHead : public ::testing::Test {
 protected:
  void feed_at(std::int64_t ms) {
    const Eigen::Isometry3d T(frames::rotation(0, 0, 0.001 * static_cast<double>(ms)));
    const auto fed = frames_.feed("robot", "head", kStart + ms * 1ms, T);
    EXPECT_TRUE(fed) << fed.error().text();
  }
  void ask(std::int64_t ms) {
    frames_.when_known("robot", "head", kStart + ms * 1ms, [this](const auto& T) {
      answers_.push_back(T ? Eigen::AngleAxisd(T->linear()).angle() : -1);
    });
  }
  DefaultHead() { clock_.advance(kStart.time_since_epoch()); }
  void pass(std::int64_t ms) { clock_.advance(std::chrono::milliseconds(ms)); }

  ManualClock clock_;
  Module module_{"test", "A test.", {.clock = &clock_}};
  ModuleFrames frames_{module_, {.input = false}};
  std::vector<double> answers_;
};

TEST_F(DefaultHead, is_known_without_a_graph) {
  const Eigen::Isometry3d T = frames_.fixed("left_eye", "right_eye");
  EXPECT_NEAR((T.translation() - Eigen::Vector3d(0.1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((T.linear() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
  const Eigen::Isometry3d T_world_head = frames_.nearest("world", "head", kStart);
  EXPECT_NEAR((T_world_head.translation() - Eigen::Vector3d(0, 0, 1.2)).norm(), 0, 1e-12);
  EXPECT_THROW(static_cast<void>(frames_.fixed("world", "head")), ModuleError);
}

TEST_F(DefaultHead, a_time_that_is_not_given_is_now) {
  feed_at(0);
  feed_at(10);
  feed_at(20);
  pass(10);
  EXPECT_NEAR(Eigen::AngleAxisd(frames_.nearest("robot", "head", Time()).linear()).angle(), 0.010,
              1e-9);
  EXPECT_NEAR(Eigen::AngleAxisd(frames_.lookup("robot", "head", Time())->linear()).angle(), 0.010,
              1e-9);
  frames_.when_known("robot", "head", Time(), [this](const auto& T) {
    answers_.push_back(T ? Eigen::AngleAxisd(T->linear()).angle() : -1);
  });
  ASSERT_EQ(answers_.size(), 1);
  EXPECT_NEAR(answers_[0], 0.010, 1e-9);
}

TEST_F(DefaultHead, a_time_to_come_is_waited_for_as_long_as_poses_come) {
  feed_at(0);
  ask(10);
  ask(4);
  EXPECT_TRUE(frames_.awaits("robot", "left_eye", kStart + 1ns));
  EXPECT_FALSE(frames_.awaits("head", "left_eye", kStart + 1ns));
  feed_at(5);
  EXPECT_TRUE(answers_.empty()) << "in the order of asking";
  feed_at(20);
  ASSERT_EQ(answers_.size(), 2);
  EXPECT_NEAR(answers_[0], 0.010, 1e-9);
  EXPECT_NEAR(answers_[1], 0.004, 1e-9);
  ask(30);
  pass(99);
  frames_.answer_known();
  EXPECT_EQ(answers_.size(), 2);
  pass(1);
  frames_.answer_known();
  EXPECT_EQ(answers_.at(2), -1);
  EXPECT_NEAR(Eigen::AngleAxisd(frames_.nearest("robot", "head", kStart + 30ms).linear()).angle(),
              0.020, 1e-9);
}

TEST_F(DefaultHead, a_time_of_a_wrong_clock_is_not_waited_for) {
  feed_at(0);
  for (const Time ahead : {kStart + 1001ms, kStart + 24h, Time::max()}) {
    EXPECT_FALSE(frames_.awaits("robot", "head", ahead));
    frames_.when_known("robot", "head", ahead, [this](const auto& T) {
      EXPECT_FALSE(T);
      answers_.push_back(0);
    });
  }
  EXPECT_EQ(answers_.size(), 3U);
  EXPECT_TRUE(frames_.awaits("robot", "head", kStart + 1000ms));
  ask(5);
  feed_at(10);
  ASSERT_EQ(answers_.size(), 4U) << "the next one does not wait behind them";
  EXPECT_NEAR(answers_[3], 0.005, 1e-9);
  feed_at(60'000);
  EXPECT_TRUE(frames_.awaits("robot", "head", kStart + 60s + 50ms)) << "poses have that clock, too";
}

// A handler that takes 150 ms is followed by an image before the poses of that time.
TEST_F(DefaultHead, a_pose_that_waits_in_the_input_is_waited_for) {
  Module module{"test", "A test.", {.clock = &clock_}};
  ModuleFrames frames{module};
  const auto feed = [&](std::int64_t ms) {
    ASSERT_TRUE(
        frames.feed("robot", "head", kStart + ms * 1ms,
                    Eigen::Isometry3d(frames::rotation(0, 0, 0.001 * static_cast<double>(ms)))));
  };
  feed(0);
  pass(150);
  frames.when_known("robot", "head", kStart + 130ms, [this](const auto& T) {
    answers_.push_back(T ? Eigen::AngleAxisd(T->linear()).angle() : -1);
  });
  EXPECT_TRUE(answers_.empty());
  feed(140);
  ASSERT_EQ(answers_.size(), 1);
  EXPECT_NEAR(answers_[0], 0.130, 1e-9);
}

TEST_F(DefaultHead, without_any_pose_nothing_is_waited_for) {
  ask(1);
  EXPECT_EQ(answers_, std::vector<double>{-1});
}

TEST_F(DefaultHead, a_clock_that_was_set_back_starts_over) {
  feed_at(3'600'000);
  feed_at(0);
  feed_at(10);
  ask(5);
  ASSERT_EQ(answers_.size(), 1);
  EXPECT_NEAR(answers_[0], 0.005, 1e-9);
}

TEST_F(DefaultHead, few_wait) {
  feed_at(0);
  for (int i = 0; i < 300; ++i) ask(10);
  EXPECT_EQ(answers_.size(), 300 - 256);
  frames_.answer_all();
  EXPECT_EQ(answers_.size(), 300);
}

}  // namespace
}  // namespace hc
