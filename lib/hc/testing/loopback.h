// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: ports of this host, free ones and unresponsive ones.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <string>

#include <hc/os/descriptor.h>
#include <hc/os/socket.h>

namespace hc::testing {

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

/// A port that is currently free.
inline std::string free_port() {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

inline Address loopback_address(std::uint16_t port) {
  sockaddr_in address = loopback(port);
  return {&address, sizeof address};
}

/// An unresponsive port of 127.0.0.1: its backlog is full.
class SilentPort {
 public:
  SilentPort() {
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    auto* place = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listening_.get(), place, size), 0);
    EXPECT_EQ(::getsockname(listening_.get(), place, &size), 0);
    EXPECT_EQ(::listen(listening_.get(), 0), 0);
    port_ = ntohs(address.sin_port);
    for (auto& socket : waiting_) {
      socket = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
      ::connect(socket.get(), place, size);
    }
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  Descriptor listening_{::socket(AF_INET, SOCK_STREAM, 0)};
  std::array<Descriptor, 4> waiting_;
  std::uint16_t port_ = 0;
};

}  // namespace hc::testing
