// SPDX-License-Identifier: Apache-2.0
#include <hc/os/socket.h>

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <thread>

#include <hc/base/backoff.h>

namespace hc {
Address::Address(const void* data, unsigned length) : size(length) {
  HC_CHECK(length <= sizeof storage, length);
  std::memcpy(&storage, data, length);
}

Result<Descriptor> open_socket(const Address& address) {
  return open_descriptor("socket", "", [&] {
    return ::socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  });
}

bool is_with_itself(int socket) {
  sockaddr_storage own{}, other{};
  socklen_t size = sizeof own, other_size = sizeof other;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &size) != 0 ||
      ::getpeername(socket, reinterpret_cast<sockaddr*>(&other), &other_size) != 0)
    return false;
  bool is_tcp = own.ss_family == AF_INET || own.ss_family == AF_INET6;
  if (!is_tcp || size != other_size || std::memcmp(&own, &other, size) != 0) return false;
  // Reset, or the port would be in TIME_WAIT for a minute.
  const linger at_once{1, 0};
  ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  return true;
}

ListeningSocket::~ListeningSocket() {
  if (descriptor && !unlink_path.empty()) ::unlink(unlink_path.c_str());
}

bool is_of_this_host(Address address) {
  Descriptor probe(::socket(address.storage.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  reinterpret_cast<sockaddr_in&>(address.storage).sin_port = 0;  // sin6_port has the same offset
  return ::bind(probe.get(), address.get(), address.size) == 0 || errno != EADDRNOTAVAIL;
}

Result<Descriptor> bind_socket(const Address& address, const std::string& name) {
  auto socket = HC_TRY(open_socket(address));
  int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  ::setsockopt(socket.get(), IPPROTO_IP, IP_FREEBIND, &on, sizeof on);  // of IPv6 too
  HC_TRY(
      system_call("bind", name, [&] { return ::bind(socket.get(), address.get(), address.size); }));
  return socket;
}

Result<Descriptor> listen_on(const Address& address, const std::string& name) {
  auto socket = HC_TRY(bind_socket(address, name));
  constexpr int kBacklog = 1024;  // connections in the backlog use no descriptor
  HC_TRY(system_call("listen", name, [&] { return ::listen(socket.get(), kBacklog); }));
  return socket;
}

Result<ConnectedSocket> ListeningSocket::accept(const LogSink& log) const {
  if (take_agreed) return take_agreed(log);
  while (true) {
    int number = ::accept4(descriptor.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (number >= 0) {
      ConnectedSocket peer{Descriptor(number)};
      auto admitted = admit ? admit(number) : Status();
      if (!admitted) {
        if (log) log(Level::Warning, admitted.error().detail);
        continue;
      }
      set_up_connection(number);
      return peer;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) return ConnectedSocket();
    if (errno != EINTR && errno != ECONNABORTED) return system_error("accept", "");
  }
}

void set_up_connection(int socket) {
  // Limits the kernel's exponential backoff of retransmissions and window probes, which otherwise
  // grows to minutes, so that a restored link is used soon. Ignored before Linux 6.15.
  constexpr int kLongestPause = 44;  // TCP_RTO_MAX_MS
  const std::array<std::array<int, 3>, 6> options = {{{IPPROTO_TCP, TCP_NODELAY, 1},
                                                      {SOL_SOCKET, SO_KEEPALIVE, 1},
                                                      {IPPROTO_TCP, TCP_KEEPIDLE, 1},
                                                      {IPPROTO_TCP, TCP_KEEPINTVL, 1},
                                                      {IPPROTO_TCP, TCP_KEEPCNT, 2},
                                                      {IPPROTO_TCP, kLongestPause, 1000}}};
  for (const auto& [level, name, value] : options)
    ::setsockopt(socket, level, name, &value, sizeof value);
}

void set_up_reader(int socket) {
  // The kernel checks this at its third keepalive probe, after 3 s.
  constexpr unsigned kMilliseconds = 2500;
  ::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &kMilliseconds, sizeof kMilliseconds);
}

PeerLook look_at_peer(int socket) {
  using std::chrono::milliseconds;
  constexpr milliseconds kSoonest{50}, kLatest{1000};
  tcp_info info{};
  socklen_t size = sizeof info;
  int unanswered = 0;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {};
  if (::ioctl(socket, SIOCOUTQ, &unanswered) != 0 || unanswered == 0) return {};
  // With a zero window nothing is retransmitted, but the reader is probed.
  auto asked = std::max(info.tcpi_retransmits, info.tcpi_probes);
  milliseconds silent(info.tcpi_last_ack_recv);
  return {asked >= 2 && silent >= kVanishTime, true,
          std::clamp(kVanishTime - silent, kSoonest, kLatest)};
}

void await_acknowledgement(int socket, std::chrono::milliseconds longest) {
  const auto end = std::chrono::steady_clock::now() + longest;
  Backoff backoff(std::chrono::milliseconds(1), std::chrono::milliseconds(50));
  int unanswered = 0;
  while (::ioctl(socket, SIOCOUTQ, &unanswered) == 0 && unanswered > 0 &&
         std::chrono::steady_clock::now() < end && !look_at_peer(socket).vanished) {
    pollfd polled{socket, 0, 0};
    if (::poll(&polled, 1, 0) > 0 && (polled.revents & POLLERR) != 0) return;
    std::this_thread::sleep_for(backoff.next());  // poll() does not report acknowledgements
  }
}

}  // namespace hc
