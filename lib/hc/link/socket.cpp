// SPDX-License-Identifier: Apache-2.0
#include <hc/link/socket.h>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <optional>

#include <hc/link/stream_link.h>

namespace hc::internal {
namespace {

constexpr int kBacklog = 128;

Result<Descriptor> open_socket(const void* address) {
  int family = static_cast<const sockaddr*>(address)->sa_family;
  auto number = system_call("socket", "", [&] {
    return ::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  });
  if (!number) return number.error();
  return Descriptor(*number);
}

/// Small messages leave at once, and a peer that vanishes while nothing is said is noticed within
/// kVanishTime: asked after 1, 2 and 3 s, given up after 4 s. Harmless where the socket is not TCP.
void set_up(int socket) {
  static_assert(kVanishTime == std::chrono::seconds(4));
  const std::array<std::array<int, 3>, 5> options = {{{IPPROTO_TCP, TCP_NODELAY, 1},
                                                      {SOL_SOCKET, SO_KEEPALIVE, 1},
                                                      {IPPROTO_TCP, TCP_KEEPIDLE, 1},
                                                      {IPPROTO_TCP, TCP_KEEPINTVL, 1},
                                                      {IPPROTO_TCP, TCP_KEEPCNT, 3}}};
  for (const auto& [level, name, value] : options)
    ::setsockopt(socket, level, name, &value, sizeof value);
}

/// One try; none (-1) when nobody listens there, or answers before `deadline`.
Result<Descriptor> try_to_connect(const Address& address, const std::string& name,
                                  Deadline deadline, int stop) {
  auto socket = open_socket(address.data);
  if (!socket) return socket;
  if (::connect(socket->get(), static_cast<const sockaddr*>(address.data), address.size) == 0)
    return socket;
  if (errno == EINPROGRESS) {
    auto answered = wait_for(socket->get(), POLLOUT, stop, deadline);
    if (!answered) return answered.error();
    if (!*answered) return Descriptor();
    int status = 0;
    socklen_t status_size = sizeof status;
    ::getsockopt(socket->get(), SOL_SOCKET, SO_ERROR, &status, &status_size);
    if (status == 0) return socket;
    errno = status;
  }
  // EAGAIN: the backlog of a Unix socket is full for now.
  if (errno == ECONNREFUSED || errno == ENOENT || errno == EAGAIN || errno == ETIMEDOUT)
    return Descriptor();
  return system_error("connect", name);
}

}  // namespace

ListeningSocket::~ListeningSocket() {
  if (descriptor && !unlink_path.empty()) ::unlink(unlink_path.c_str());
}

Result<Descriptor> connect_to(std::span<const Address> addresses, const std::string& name,
                              std::chrono::seconds wait, int stop) {
  using std::chrono::steady_clock;
  const auto begin = steady_clock::now();
  const auto last_answer = begin + (wait > std::chrono::seconds(0) ? wait : kAnswerTime);
  Pauses pauses;
  while (true) {
    std::optional<Error> failed;
    bool may_come = false;  // somebody may listen there later
    for (std::size_t i = 0; i < addresses.size(); ++i) {
      auto now = steady_clock::now();
      auto share = (last_answer - now) / static_cast<std::int64_t>(addresses.size() - i);
      auto connected = try_to_connect(addresses[i], name, now + share, stop);
      if (connected && *connected) {
        set_up(connected->get());
        return connected;
      }
      if (!connected && connected.error().code == Code::Stopped) return connected;
      if (connected)
        may_come = true;
      else
        failed = connected.error();
    }
    if (!may_come && failed) return *failed;
    if (steady_clock::now() >= begin + wait)
      return Error{Code::Closed, "connect(" + name + "): nobody listens there"};
    if (auto waited = pauses.next(stop); !waited) return waited.error();
  }
}

Result<Descriptor> listen_on(const void* address, unsigned size, const std::string& name) {
  auto socket = open_socket(address);
  if (!socket) return socket.error();
  int on = 1;
  ::setsockopt(socket->get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  auto bound = system_call("bind", name, [&] {
    return ::bind(socket->get(), static_cast<const sockaddr*>(address), size);
  });
  if (!bound) return bound.error();
  auto listening = system_call("listen", name, [&] { return ::listen(socket->get(), kBacklog); });
  if (!listening) return listening.error();
  return socket;
}

Result<Descriptor> accept_peer(const ListeningSocket& socket, const LinkOptions& options) {
  while (true) {
    int number = ::accept4(socket.descriptor.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (number >= 0) {
      Descriptor peer(number);
      auto admitted = socket.admit ? socket.admit(number) : Status();
      if (!admitted) {
        if (options.log) options.log(Severity::Warning, admitted.error().text());
        continue;
      }
      set_up(number);
      return peer;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) return Descriptor();
    if (errno != EINTR && errno != ECONNABORTED) return system_error("accept", "");
  }
}

}  // namespace hc::internal
