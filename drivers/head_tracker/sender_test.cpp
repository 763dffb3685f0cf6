// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/head_tracker.h>
#include <drivers/head_tracker/sender.h>

#include <chrono>
#include <string>

#include <gtest/gtest.h>

namespace {

TEST(HeadPoseSender, is_heard_by_a_head_tracker) {
  auto tracker = hc::HeadTracker::open("127.0.0.1", 0, {{}, std::chrono::seconds(1)});
  ASSERT_TRUE(tracker);
  auto sender = hc::HeadPoseSender::open("127.0.0.1:" + std::to_string(tracker->port()));
  ASSERT_TRUE(sender);
  hc::HeadPose pose;
  pose.R = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  ASSERT_TRUE(sender->send(pose));
  int ignored = 0;
  const auto heard = tracker->receive({}, [&](const auto&...) { ++ignored; });
  ASSERT_TRUE(heard && *heard);
  EXPECT_NEAR((*heard)->pose.angles().z(), 0.5, 1e-9);
  EXPECT_EQ(ignored, 0);
}

TEST(HeadPoseSender, an_address_that_is_none_is_an_error) {
  for (const char* address : {"", "4242", "nowhere:4242", "127.0.0.1", "127.0.0.1:0", "[::1]:4242"})
    EXPECT_FALSE(hc::HeadPoseSender::open(address)) << address;
}

TEST(HeadPoseSender, continues_when_nobody_hears_it) {
  int port = 0;
  {
    auto tracker = hc::HeadTracker::open("127.0.0.1", 0, {{}, std::chrono::seconds(1)});
    ASSERT_TRUE(tracker);
    port = tracker->port();
  }
  auto sender = hc::HeadPoseSender::open("127.0.0.1:" + std::to_string(port));
  ASSERT_TRUE(sender);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(sender->send({}));
}

}  // namespace
