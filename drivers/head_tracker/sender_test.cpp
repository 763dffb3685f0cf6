// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/head_tracker.h>
#include <drivers/head_tracker/sender.h>

#include <gtest/gtest.h>

namespace {

TEST(HeadPoseSender, is_heard_by_a_head_tracker) {
  auto tracker = hc::HeadTracker::open("127.0.0.1", 0);
  ASSERT_TRUE(tracker);
  auto sender = hc::HeadPoseSender::open(tracker->port());
  ASSERT_TRUE(sender);
  hc::HeadPose pose;
  pose.R = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  ASSERT_TRUE(sender->send(pose));
  const auto heard = tracker->receive();
  ASSERT_TRUE(heard && *heard);
  EXPECT_NEAR((*heard)->pose.angles().z(), 0.5, 1e-9);
  EXPECT_EQ(tracker->ignored(), 0U);
}

TEST(HeadPoseSender, continues_when_nobody_hears_it) {
  int port = 0;
  {
    auto tracker = hc::HeadTracker::open("127.0.0.1", 0);
    ASSERT_TRUE(tracker);
    port = tracker->port();
  }
  auto sender = hc::HeadPoseSender::open(port);
  ASSERT_TRUE(sender);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(sender->send({}));
}

}  // namespace
