// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/senders.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <gtest/gtest.h>

namespace {

using std::chrono::milliseconds;

constexpr uid_t kOther = 12345;

sockaddr_storage address(const std::string& host, std::uint16_t port) {
  sockaddr_storage made{};
  auto& four = reinterpret_cast<sockaddr_in&>(made);
  auto& six = reinterpret_cast<sockaddr_in6&>(made);
  if (::inet_pton(AF_INET, host.c_str(), &four.sin_addr) == 1) {
    four.sin_family = AF_INET;
  } else {
    EXPECT_EQ(::inet_pton(AF_INET6, host.c_str(), &six.sin6_addr), 1) << host;
    six.sin6_family = AF_INET6;
  }
  four.sin_port = htons(port);
  return made;
}

class SendersTest : public ::testing::Test {
 protected:
  /// "heard" if a packet from there is accepted, otherwise the reason.
  std::string admit(const std::string& host, std::uint16_t port) {
    const auto status = senders.admit(address(host, port), now);
    return status ? "heard" : status.error().detail;
  }

  /// User by port on this host; -1: none.
  std::map<int, std::optional<uid_t>> users{
      {1, ::geteuid()}, {2, kOther}, {3, ::geteuid()}, {4, 0}, {5, {}}};
  int looks = 0;
  hc::MonotonicTime now{milliseconds(5000)};
  hc::Senders senders{{"192.0.2.7", "2001:db8::7"},
                      milliseconds(1000),
                      [this](const sockaddr_storage& from) -> hc::Result<std::optional<uid_t>> {
                        ++looks;
                        const int port = ntohs(reinterpret_cast<const sockaddr_in&>(from).sin_port);
                        if (port == 9) return hc::Error{hc::Code::NotFound, "closed"};
                        const auto user = users.find(port);
                        return user == users.end() ? std::optional<uid_t>(kOther) : user->second;
                      }};
};

TEST_F(SendersTest, another_user_is_not_heard) {
  EXPECT_EQ(admit("127.0.0.1", 2), "127.0.0.1 port 2, another user (uid 12345)");
  EXPECT_EQ(admit("127.0.0.1", 9), "127.0.0.1 port 9, an unknown user: closed");
  EXPECT_EQ(admit("::1", 2), "::1 port 2, another user (uid 12345)");
  EXPECT_EQ(admit("192.0.2.7", 2), "192.0.2.7 port 2, another user (uid 12345)");  // named or not
  EXPECT_EQ(admit("127.0.0.1", 1), "heard");
}

TEST_F(SendersTest, root_is_heard) {
  EXPECT_EQ(admit("::1", 4), "heard");
}

TEST_F(SendersTest, of_other_hosts_those_that_are_named) {
  EXPECT_EQ(admit("192.0.2.8", 5), "192.0.2.8 port 5: another host, not listed in `sender`");
  EXPECT_EQ(admit("::ffff:192.0.2.7", 5), "heard");
  now += milliseconds(1001);
  EXPECT_EQ(admit("2001:db8::7", 5), "heard");
}

TEST_F(SendersTest, one_is_heard_until_it_is_silent) {
  EXPECT_EQ(admit("127.0.0.1", 1), "heard");
  now += milliseconds(999);
  EXPECT_EQ(admit("127.0.0.1", 3),
            "another sender, 127.0.0.1 port 3, while 127.0.0.1 port 1 sends");
  EXPECT_EQ(admit("127.0.0.1", 1), "heard");
  now += milliseconds(1001);
  EXPECT_EQ(admit("127.0.0.1", 3), "heard");
  EXPECT_NE(admit("127.0.0.1", 1), "heard");
}

TEST_F(SendersTest, an_address_that_another_user_took_over_is_not_heard_any_more) {
  EXPECT_EQ(admit("127.0.0.1", 1), "heard");
  users[1] = kOther;
  EXPECT_EQ(admit("127.0.0.1", 1), "heard");  // of the same batch
  senders.begin();
  EXPECT_NE(admit("127.0.0.1", 1), "heard");
  EXPECT_EQ(admit("127.0.0.1", 3), "heard");  // whose turn it is now
}

TEST_F(SendersTest, many_senders_cost_few_looks) {
  for (std::uint16_t port = 100; port < 1100; ++port) EXPECT_NE(admit("127.0.0.1", port), "heard");
  EXPECT_EQ(looks, 8);
  senders.begin();
  EXPECT_EQ(admit("127.0.0.1", 1), "heard");
  for (std::uint16_t port = 100; port < 1100; ++port) EXPECT_NE(admit("127.0.0.1", port), "heard");
  EXPECT_EQ(looks, 9);
}

}  // namespace
