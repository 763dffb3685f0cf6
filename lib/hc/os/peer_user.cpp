// SPDX-License-Identifier: Apache-2.0
#include <hc/os/peer_user.h>

#include <arpa/inet.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <string>

#include <hc/os/descriptor.h>

namespace hc {
namespace {

struct Request {
  nlmsghdr header{sizeof(Request), SOCK_DIAG_BY_FAMILY, NLM_F_REQUEST, 0, 0};
  inet_diag_req_v2 wanted{};
};

struct Reply {
  nlmsghdr header;
  union {
    inet_diag_msg found;
    nlmsgerr failed;
  };
};

bool is_loopback(const sockaddr_storage& address) {
  if (address.ss_family == AF_INET)
    return ntohl(reinterpret_cast<const sockaddr_in&>(address).sin_addr.s_addr) >>
               IN_CLASSA_NSHIFT ==
           IN_LOOPBACKNET;
  const auto& six = reinterpret_cast<const sockaddr_in6&>(address).sin6_addr;
  return address.ss_family == AF_INET6 &&  // or ::ffff:127.0.0.1, an IPv4 peer
         (IN6_IS_ADDR_LOOPBACK(&six) || (IN6_IS_ADDR_V4MAPPED(&six) && six.s6_addr[12] == 127));
}

/// Writes an address into a request; returns its port in network byte order.
in_port_t put(const sockaddr_storage& address, __be32* words) {
  if (address.ss_family == AF_INET) {
    const auto& place = reinterpret_cast<const sockaddr_in&>(address);
    words[0] = place.sin_addr.s_addr;
    return place.sin_port;
  }
  const auto& place = reinterpret_cast<const sockaddr_in6&>(address);
  std::memcpy(words, &place.sin6_addr, sizeof place.sin6_addr);
  return place.sin6_port;
}

/// The owner of the TCP socket with these addresses; without a remote one, of the listening socket.
///
/// Source: man 7 sock_diag. Errors: NotFound (also a socket without an owner, not accepted yet or
/// already closed), System.
Result<uid_t> user_of(const sockaddr_storage& end, const sockaddr_storage* other) {
  Request request;
  request.wanted.sdiag_family = static_cast<std::uint8_t>(end.ss_family);
  request.wanted.sdiag_protocol = IPPROTO_TCP;
  request.wanted.idiag_states = ~0U;
  auto& id = request.wanted.id;
  id.idiag_sport = put(end, id.idiag_src);
  if (other != nullptr) id.idiag_dport = put(*other, id.idiag_dst);
  id.idiag_cookie[0] = id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
  Descriptor kernel(::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  Reply reply{};
  if (::send(kernel.get(), &request, sizeof request, 0) < 0 ||
      ::recv(kernel.get(), &reply, sizeof reply, 0) < 0)
    return system_error("sock_diag", "");
  const int number = reply.header.nlmsg_type == NLMSG_ERROR ? -reply.failed.error : 0;
  if (number != 0 && number != ENOENT) return system_error("sock_diag", "", number);
  if (number != 0 || reply.found.idiag_inode == 0)
    return Error{Code::NotFound, "the kernel (sock_diag) does not find its socket"};
  return reply.found.idiag_uid;
}

}  // namespace

Result<uid_t> tcp_peer_user(int socket, Connected how) {
  sockaddr_storage own{}, peer{};
  socklen_t own_size = sizeof own, peer_size = sizeof peer;
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&own), &own_size) != 0 ||
      ::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &peer_size) != 0)
    return Error{Code::NotFound, "its socket is closed"};
  if (!is_loopback(peer)) return Error{Code::NotFound, "it is not on the loopback address"};
  auto user = user_of(peer, &own);
  return user || how == Connected::Accepted ? user : user_of(peer, nullptr);
}

Result<uid_t> unix_peer_user(int socket) {
  ucred credentials{};
  socklen_t size = sizeof credentials;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0)
    return system_error("getsockopt", "SO_PEERCRED");
  return credentials.uid;
}

Status check_own(const Result<uid_t>& peer, const std::string& what) {
  if (!peer) return Error{Code::Closed, what + "an unknown user: " + peer.error().detail};
  if (*peer == ::geteuid() || *peer == 0) return {};
  return Error{Code::Closed, what + "another user (uid " + std::to_string(*peer) + ")"};
}

}  // namespace hc
