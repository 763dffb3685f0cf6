// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/head_tracker.h>
#include <drivers/head_tracker/sender.h>

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include <hc/testing/must.h>

namespace {

hc::HeadTracker listening() {
  return hc::must(hc::HeadTracker::open("127.0.0.1", 0, {{}, std::chrono::seconds(1)}));
}

hc::HeadPoseSender sender_to(int port) {
  return hc::must(hc::HeadPoseSender::open("127.0.0.1:" + std::to_string(port)));
}

TEST(HeadPoseSender, is_heard_by_a_head_tracker) {
  auto tracker = listening();
  auto sender = sender_to(tracker.port());
  hc::HeadPose pose;
  pose.R = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  ASSERT_TRUE(sender.send(pose));
  int ignored = 0;
  const auto heard = hc::must(tracker.receive({}, [&](const auto&...) { ++ignored; }));
  ASSERT_TRUE(heard);
  EXPECT_NEAR(heard->pose.angles().z(), 0.5, 1e-9);
  EXPECT_EQ(ignored, 0);
}

TEST(HeadPoseSender, an_address_that_is_none_is_an_error) {
  for (const char* address : {"", "4242", "nowhere:4242", "127.0.0.1", "127.0.0.1:0", "[::1]:4242"})
    EXPECT_FALSE(hc::HeadPoseSender::open(address)) << address;
}

TEST(HeadPoseSender, continues_when_nobody_hears_it) {
  auto sender = sender_to(listening().port());  // closed at once
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(sender.send({}));
}

}  // namespace
