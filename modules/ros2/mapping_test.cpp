// SPDX-License-Identifier: Apache-2.0
#include "mapping.h"

#include <gtest/gtest.h>

#include "names.h"

namespace {

using hc::ros::Type;

TEST(Mapping, reads_what_is_published) {
  const auto all = parse_publish(
      "eyes.left=/left/image_raw:sensor_msgs/msg/CompressedImage rate=10 qos=best_effort, "
      "neck.pose=/pose,\n  frames=/tf");
  ASSERT_TRUE(all) << all.error().detail;
  ASSERT_EQ(all->size(), 3u);
  EXPECT_EQ(all->at(0).port, "eyes.left");
  EXPECT_EQ(all->at(0).topic, "/left/image_raw");
  EXPECT_EQ(all->at(0).type, Type::CompressedImage);
  EXPECT_EQ(all->at(0).rate, 10);
  EXPECT_EQ(all->at(0).reliable, false);
  EXPECT_FALSE(all->at(1).type);
  EXPECT_EQ(all->at(2).type, Type::TfMessage);
  EXPECT_TRUE(parse_publish("")->empty());
}

TEST(Mapping, reads_what_is_subscribed) {
  const auto all = parse_subscribe(
      "/cmd_vel=twist rate=50, /tf:tf2_msgs/msg/TFMessage=pose child=base_link coord=2003, "
      "/joints=joints joints=pan+tilt qos=reliable");
  ASSERT_TRUE(all) << all.error().detail;
  EXPECT_EQ(all->at(0).type, Type::Twist);
  EXPECT_EQ(all->at(1).choice.child, "base_link");
  EXPECT_EQ(all->at(1).coord, 2003);
  EXPECT_EQ(all->at(2).choice.joints, (std::vector<std::string>{"pan", "tilt"}));
  EXPECT_EQ(all->at(2).reliable, true);
}

TEST(Mapping, refuses_the_rest_in_one_line) {
  for (const char* bad :
       {"eyes.left", "eyes.left=", "=/a", "eyes=/a", "eyes.left=a", "eyes.left=/1a",
        "eyes.left=/a/", "eyes.left=/a:Image", "eyes.left=/a:rcl_interfaces/msg/Log",
        "eyes.left=/a rate=0", "eyes.left=/a rate=x", "eyes.left=/a qos=x", "eyes.left=/a x=1",
        "a.b=/a, c.d=/a", "frames=/tf:std_msgs/msg/String", "a.b=/tf:tf2_msgs/msg/TFMessage"}) {
    const auto refused = parse_publish(bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().code, hc::Code::Invalid);
    EXPECT_EQ(refused.error().detail.find('\n'), std::string::npos);
  }
  for (const char* bad :
       {"/a", "/a=b", "/a:std_msgs/msg/String=twist", "/a=twist, /b=twist", "/a=twist child=b",
        "/tf:tf2_msgs/msg/TFMessage=pose", "/a=twist joints=b", "/a=twist coord=-1", "a=twist"})
    EXPECT_FALSE(parse_subscribe(bad)) << bad;
}

TEST(Mapping, rates_are_kept) {
  RateLimit ten(10), all(0);
  int passed = 0;
  for (std::chrono::milliseconds now{0}; now.count() < 2000; ++now) {
    EXPECT_TRUE(all.passes(now));
    if (ten.passes(now + std::chrono::seconds(7))) ++passed;
  }
  EXPECT_GE(passed, 19);
  EXPECT_LE(passed, 21);
}

TEST(Names, are_those_of_ros) {
  EXPECT_EQ(dds_type("sensor_msgs/msg/Image"), "sensor_msgs::msg::dds_::Image_");
  EXPECT_EQ(dds_topic("/camera/image_raw"), "rt/camera/image_raw");
  EXPECT_TRUE(is_topic("/a/_b1"));
  for (const char* bad : {"", "/", "a", "/a//b", "/a b", "/a-b", "/a/"})
    EXPECT_FALSE(is_topic(bad)) << bad;
}

}  // namespace
