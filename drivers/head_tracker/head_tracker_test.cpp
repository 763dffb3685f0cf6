// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/head_tracker.h>

#include <arpa/inet.h>
#include <hc/base/clock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <hc/testing/must.h>

namespace {

using hc::HeadTracker;

class Sender {
 public:
  explicit Sender(int port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;
  ~Sender() { ::close(socket_); }
  void send(const void* data, std::size_t size) const {
    EXPECT_EQ(::send(socket_, data, size, 0), static_cast<ssize_t>(size));
  }
  void send(const std::array<double, 6>& numbers) const { send(numbers.data(), 48); }

 private:
  int socket_;
};

/// Counts ignored packets.
struct Ignored {
  int count = 0;
  std::string last;
  hc::Problem problem = [this](const std::string& kind, std::string_view line) {
    ++count;
    last = kind + ": " + std::string(line);
  };
};

/// Accepts packets only from this host.
hc::Senders nobody() {
  return {{}, std::chrono::seconds(1)};
}

HeadTracker opened() {
  return hc::must(HeadTracker::open("127.0.0.1", 0, nobody()));
}

TEST(HeadTracker, gives_the_newest_pose_with_its_time) {
  auto tracker = opened();
  Ignored ignored;
  const Sender sender(tracker.port());
  const hc::Time before = hc::SystemClock().wall();
  sender.send({0, 0, -100, 0, 0, 0});
  sender.send({0, 0, -200, 0, 0, 0});
  const auto got = hc::must(tracker.receive({}, ignored.problem));
  ASSERT_TRUE(got);
  EXPECT_DOUBLE_EQ(got->pose.p.x(), 2);
  EXPECT_GE(got->time, before);
  EXPECT_LE(got->time, hc::SystemClock().wall());
  EXPECT_EQ(ignored.count, 0);
  EXPECT_FALSE(hc::must(tracker.receive({}, ignored.problem)));
}

TEST(HeadTracker, ignores_and_counts_garbage) {
  auto tracker = opened();
  Ignored ignored;
  const Sender sender(tracker.port());
  const std::vector<char> large(9000, 'x');
  sender.send("", 0);
  sender.send("hello", 5);
  sender.send(large.data(), large.size());
  sender.send(large.data(), 49);
  sender.send({0, 0, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_FALSE(hc::must(tracker.receive({}, ignored.problem)));
  EXPECT_EQ(ignored.count, 5);
  EXPECT_EQ(ignored.last, "invalid packet: ignored a packet whose yaw is nan");
  sender.send({0, 100, 0, 0, 0, 0});
  sender.send("bye", 3);
  const auto got = hc::must(tracker.receive({}, ignored.problem));
  ASSERT_TRUE(got);
  EXPECT_DOUBLE_EQ(got->pose.p.z(), 1);
  EXPECT_EQ(ignored.count, 6);
}

TEST(HeadTracker, hears_this_user_by_either_family) {
  auto tracker = HeadTracker::open("::", 0, nobody());
  if (!tracker) GTEST_SKIP() << "no IPv6 here: " << tracker.error().detail;
  Ignored ignored;
  const Sender sender(tracker->port());  // of IPv4
  sender.send({0, 0, -100, 0, 0, 0});
  auto got = tracker->receive({}, ignored.problem);
  EXPECT_TRUE(got && *got) << ignored.last;
}

TEST(HeadTracker, a_port_in_use_is_an_error) {
  auto tracker = opened();
  EXPECT_EQ(hc::refused(HeadTracker::open("127.0.0.1", tracker.port(), nobody())).detail,
            "UDP port " + std::to_string(tracker.port()) + " of 127.0.0.1: Address already in use");
}

TEST(HeadTracker, a_wrong_host_is_an_error) {
  EXPECT_EQ(hc::refused(HeadTracker::open("999.0.0.1.", 0, nobody())).code, hc::Code::Invalid);
  // An address of another machine.
  EXPECT_EQ(hc::refused(HeadTracker::open("192.0.2.1", 0, nobody())).code, hc::Code::System);
}

}  // namespace
