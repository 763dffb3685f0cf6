// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/tracked_head.h>

#include <drivers/head_tracker/sender.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <hc/testing/must.h>

namespace {

using std::chrono::milliseconds;

class TrackedHeadTest : public ::testing::Test {
 protected:
  hc::TrackedHead head(int port, bool centre_first = true) {
    return {{"127.0.0.1", port, {}, kSilence, centre_first},
            [this](hc::Level, std::string_view line) { log.emplace_back(line); },
            [this](const std::string& kind, std::string_view line) {
              problems.push_back(kind + ": " + std::string(line));
            }};
  }
  /// A listening tracker and a sender.
  hc::TrackedHead connected(bool centre_first = true) {
    auto made = head(0, centre_first);
    EXPECT_TRUE(made.pass(now));
    EXPECT_EQ(log.size(), 1U);
    const std::string before = "listening on UDP ";
    EXPECT_TRUE(log.back().starts_with(before)) << log.back();
    address = log.back().substr(before.size());
    sender.emplace(hc::must(hc::HeadPoseSender::open(address)));
    log.clear();
    return made;
  }
  /// Sends a pose and returns the resulting position.
  Eigen::Vector3d feed(hc::TrackedHead& head, double x) {
    EXPECT_TRUE(sender->send({.p = {x, 0, 0}}));
    const auto pose = hc::must(head.receive(now));
    EXPECT_TRUE(pose);
    return pose ? pose->pose.p : Eigen::Vector3d::Zero().eval();
  }

  static constexpr milliseconds kSilence{1000};
  hc::MonotonicTime now{milliseconds(5000)};
  std::optional<hc::HeadPoseSender> sender;
  std::string address;
  std::vector<std::string> log, problems;
};

TEST_F(TrackedHeadTest, the_first_pose_is_the_zero) {
  auto head = connected();
  EXPECT_NEAR(feed(head, 0.5).norm(), 0, 1e-12);
  EXPECT_NEAR(feed(head, 0.7).x(), 0.2, 1e-12);
  EXPECT_EQ(log, (std::vector<std::string>{
                     "receiving from the tracker",
                     "zero set to the first pose: roll 0.00, pitch 0.00, yaw 0.00 rad"}));
}

TEST_F(TrackedHeadTest, else_the_trackers_zero_stays_until_it_is_centred) {
  auto head = connected(/*centre_first=*/false);
  EXPECT_NEAR(feed(head, 0.5).x(), 0.5, 1e-12);
  head.centre();
  EXPECT_NEAR(feed(head, 0.6).x(), 0, 1e-12);
  EXPECT_NEAR(feed(head, 0.5).x(), -0.1, 1e-12);
  EXPECT_EQ(log, std::vector<std::string>{"receiving from the tracker"});
}

TEST_F(TrackedHeadTest, nothing_is_given_where_nothing_came) {
  auto head = connected();
  EXPECT_FALSE(hc::must(head.receive(now)));
  EXPECT_TRUE(log.empty());
}

TEST_F(TrackedHeadTest, silence_and_its_end_are_logged_once_each) {
  auto head = connected();
  const auto wait = [&](milliseconds time) {
    now += time;
    EXPECT_TRUE(head.pass(now));
  };
  const std::string silence = "no packets received on UDP " + address;
  wait(milliseconds(999));
  EXPECT_TRUE(log.empty());
  for (int i = 0; i < 3; ++i) wait(milliseconds(1000));
  EXPECT_EQ(log, std::vector<std::string>{silence});
  feed(head, 0);
  log.clear();
  wait(milliseconds(500));
  feed(head, 0);
  wait(milliseconds(999));
  EXPECT_TRUE(log.empty());
  wait(milliseconds(1));
  feed(head, 0);
  EXPECT_EQ(log, (std::vector<std::string>{silence, "receiving from the tracker"}));
}

TEST_F(TrackedHeadTest, invalid_packets_are_counted) {
  auto head = connected();
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(sender->send({.p = {0, 0, 2000}}));
  EXPECT_NEAR(feed(head, 1).norm(), 0, 1e-12);
  EXPECT_EQ(problems,
            std::vector<std::string>(3, "invalid packet: ignored a packet whose y is 2e+05"));
}

TEST_F(TrackedHeadTest, a_port_in_use_is_tried_again_less_and_less_often) {
  std::optional other(hc::must(hc::HeadTracker::open("127.0.0.1", 0, {{}, kSilence})));
  const int port = other->port();
  auto waiting = head(port);
  for (int i = 0; i < 310; ++i, now += milliseconds(1)) EXPECT_TRUE(waiting.pass(now));
  const std::string problem = "port in use: UDP port " + std::to_string(port) +
                              " of 127.0.0.1: Address already in use; retrying";
  EXPECT_EQ(problems, std::vector<std::string>(3, problem));  // at 0, 100 and 300 ms
  EXPECT_EQ(waiting.descriptor(), -1);
  EXPECT_TRUE(log.empty());
  other.reset();
  EXPECT_TRUE(waiting.pass(now += milliseconds(400)));
  EXPECT_GE(waiting.descriptor(), 0);
  EXPECT_EQ(log, std::vector<std::string>{"listening on UDP 127.0.0.1:" + std::to_string(port)});
}

TEST_F(TrackedHeadTest, without_a_host_it_does_not_listen) {
  hc::TrackedHead head({"", 0, {}, kSilence, true}, {}, {});
  EXPECT_TRUE(head.pass(now));
  EXPECT_EQ(head.descriptor(), -1);
  EXPECT_EQ(head.address(), "");
}

TEST_F(TrackedHeadTest, one_sender_is_heard_until_it_is_silent) {
  auto head = connected();
  feed(head, 0);
  auto other = hc::must(hc::HeadPoseSender::open(address));
  ASSERT_TRUE(other.send({.p = {1, 0, 0}}));
  EXPECT_FALSE(hc::must(head.receive(now)));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(problems[0].starts_with("packet of another: ignored a packet of another sender, "))
      << problems[0];
  now += kSilence + milliseconds(1);
  ASSERT_TRUE(other.send({.p = {1, 0, 0}}));
  EXPECT_TRUE(hc::must(head.receive(now)));
}

TEST_F(TrackedHeadTest, a_wrong_host_is_an_error) {
  hc::TrackedHead head({"999.0.0.1.", 0, {}, kSilence, true}, {}, {});
  EXPECT_EQ(hc::refused(head.pass(now)).code, hc::Code::Invalid);
}

}  // namespace
