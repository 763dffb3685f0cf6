// SPDX-License-Identifier: Apache-2.0
#include "participant.h"

#include <condition_variable>

#include <gtest/gtest.h>

#include <ros/messages.h>

namespace {

TEST(Participant, ranges_are_those_of_ros) {
  for (const char* closed : {"LOCALHOST", "OFF"})
    EXPECT_NE(configuration(closed).find("127.0.0.1"), std::string::npos);
  EXPECT_EQ(configuration("SUBNET").find("127.0.0.1"), std::string::npos);
  EXPECT_EQ(configuration("EVERYWHERE"), "");
  const std::function<void(std::string_view)> log = [](std::string_view) {};
  EXPECT_EQ(Participant::open({.range = "EVERYWHERE"}, log).error().code, hc::Code::Invalid);
  EXPECT_EQ(Participant::open({.domain = 1000}, log).error().code, hc::Code::Invalid);
}

}  // namespace
