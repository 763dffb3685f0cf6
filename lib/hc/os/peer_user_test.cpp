// SPDX-License-Identifier: Apache-2.0
#include <hc/os/peer_user.h>

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <hc/os/descriptor.h>

namespace hc {
namespace {

TEST(PeerUser, AServerOfIPv6KnowsAPeerOfIPv4) {
  const Descriptor listening(::socket(AF_INET6, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in6 all{};
  all.sin6_family = AF_INET6;
  socklen_t size = sizeof all;
  if (::bind(listening.get(), reinterpret_cast<const sockaddr*>(&all), sizeof all) != 0)
    GTEST_SKIP() << "no IPv6 here";
  ASSERT_EQ(::listen(listening.get(), 1), 0);
  ASSERT_EQ(::getsockname(listening.get(), reinterpret_cast<sockaddr*>(&all), &size), 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  place.sin_port = all.sin6_port;
  const Descriptor peer(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  ASSERT_EQ(::connect(peer.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
  const Descriptor accepted(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC));
  const auto user = tcp_peer_user(accepted.get(), Connected::Accepted);
  ASSERT_TRUE(user) << user.error().text();
  EXPECT_EQ(*user, ::geteuid());
}

}  // namespace
}  // namespace hc
