// SPDX-License-Identifier: Apache-2.0
#include <hc/os/udp_sender.h>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>

#include <hc/os/descriptor.h>

namespace hc {
namespace {

sockaddr_storage address(const char* host, std::uint16_t port) {
  sockaddr_storage made{};
  auto& four = reinterpret_cast<sockaddr_in&>(made);
  four.sin_family = AF_INET;
  four.sin_port = htons(port);
  EXPECT_EQ(::inet_pton(AF_INET, host, &four.sin_addr), 1);
  return made;
}

TEST(UdpSender, OfThisHostHasAUserWhileItsSocketIsOpen) {
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  auto own = address("127.0.0.1", 0);
  socklen_t size = sizeof(sockaddr_in);
  ASSERT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&own), size), 0);
  ASSERT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&own), &size), 0);
  const auto user = udp_sender_user(own);
  ASSERT_TRUE(user && *user);
  EXPECT_EQ(**user, ::geteuid());
  socket.reset();
  EXPECT_EQ(udp_sender_user(own).error().code, Code::NotFound);
}

TEST(UdpSender, OfAnotherHostHasNone) {
  const auto user = udp_sender_user(address("192.0.2.7", 5));
  ASSERT_TRUE(user);
  EXPECT_FALSE(*user);
}

TEST(UdpSender, WithoutADescriptorNobodyIsTakenForAnotherHosts) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  const rlimit none{0, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  const auto user = udp_sender_user(address("192.0.2.7", 5));
  ::setrlimit(RLIMIT_NOFILE, &before);
  ASSERT_FALSE(user);
  EXPECT_EQ(user.error().code, Code::NotFound);
}

}  // namespace
}  // namespace hc
