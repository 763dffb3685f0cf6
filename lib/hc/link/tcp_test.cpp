// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <netinet/in.h>

#include <hc/link/socket_test.h>

namespace hc::testing {
namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

/// A port that the kernel has just found free.
std::string free_port() {
  internal::Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

internal::Descriptor connect(const std::string& place) {
  internal::Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = loopback(parse_host_port(place)->port);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return socket;
}

const SocketScheme kTcp{"tcp", free_port, "tcp:", "tcp-listen:", connect};

INSTANTIATE_TEST_SUITE_P(Tcp, LinkConformance, ::testing::ValuesIn(both_ways(kTcp)));
INSTANTIATE_TEST_SUITE_P(Tcp, SocketLink, ::testing::Values(kTcp));

TEST(Tcp, ListensOnLoopbackUnlessAskedOtherwise) {
  std::string port = free_port().substr(10);
  auto source = source_of("tcp-listen:" + port);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  // The listening socket is the only one of this process.
  for (int number = 3; number < 64; ++number) {
    int listening = 0;
    socklen_t flag_size = sizeof listening;
    if (::getsockopt(number, SOL_SOCKET, SO_ACCEPTCONN, &listening, &flag_size) != 0 || !listening)
      continue;
    ASSERT_EQ(::getsockname(number, reinterpret_cast<sockaddr*>(&address), &size), 0);
    EXPECT_EQ(ntohl(address.sin_addr.s_addr), INADDR_LOOPBACK);
  }
  EXPECT_EQ(std::to_string(ntohs(address.sin_port)), port);
}

TEST(Tcp, AHostWithoutAnAddressIsNotFound) {
  auto source = open_source(*parse_uri("tcp:no.such.host.invalid:80"));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::NotFound);
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost")).error().code, Code::Usage);
}

}  // namespace
}  // namespace hc::testing
