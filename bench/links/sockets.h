// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stream sockets of the floors: on loopback, or of the mode `unix`. They send small messages at
// once.

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include "harness.h"

namespace bench {

/// A socket and its address: on loopback, or a name in the abstract namespace.
struct Socket {
  explicit Socket(const Setup& setup) {
    const bool is_tcp = setup.mode != "unix";
    descriptor = require(::socket(is_tcp ? AF_INET : AF_UNIX, SOCK_STREAM, 0), "socket");
    if (is_tcp) {
      auto& in = reinterpret_cast<sockaddr_in&>(address);
      in.sin_family = AF_INET;
      in.sin_port = htons(static_cast<std::uint16_t>(setup.port));
      in.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      size = sizeof in;
      int yes = 1;
      ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    } else {
      auto& un = reinterpret_cast<sockaddr_un&>(address);
      un.sun_family = AF_UNIX;
      std::string name = "hc_bench_" + setup.link;
      std::memcpy(un.sun_path + 1, name.data(), std::min(name.size(), sizeof un.sun_path - 1));
      size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    }
  }
  [[nodiscard]] const sockaddr* place() const {
    return reinterpret_cast<const sockaddr*>(&address);
  }

  int descriptor = -1;
  sockaddr_storage address{};
  socklen_t size = 0;
};

/// TCP would hold small messages back; Unix sockets have no such option.
inline int send_at_once(int socket) {
  int yes = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return socket;
}

inline int listen(const Setup& setup) {
  const Socket socket(setup);
  require(::bind(socket.descriptor, socket.place(), socket.size), "bind");
  require(::listen(socket.descriptor, setup.readers), "listen");
  return socket.descriptor;
}

inline int accept(int listening) {
  return send_at_once(require(::accept(listening, nullptr, nullptr), "accept"));
}

/// Connects as soon as somebody listens there, for 10 s at most.
inline int connect(const Setup& setup) {
  for (int tries = 0; tries < 1000; ++tries) {
    const Socket socket(setup);
    if (::connect(socket.descriptor, socket.place(), socket.size) == 0)
      return send_at_once(socket.descriptor);
    ::close(socket.descriptor);
    ::usleep(10'000);
  }
  fail("connect");
}

}  // namespace bench
