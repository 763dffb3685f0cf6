// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/head_tracker.h>

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

namespace hc {
namespace {

constexpr int kMostAtOnce = 10000;  // so that a flood does not starve the module

Error failed(const std::string& what) {
  return {Code::System, what + ": " + std::strerror(errno)};
}

/// The kernel's time of arrival of a packet, else the current time.
Time arrival(msghdr& message) {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part != nullptr; part = CMSG_NXTHDR(&message, part))
    if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SCM_TIMESTAMPNS)
      std::memcpy(&time, CMSG_DATA(part), sizeof time);
  return Time(std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec));
}

int port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port
                   : reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

}  // namespace

Result<HeadTracker> HeadTracker::open(const std::string& host, int port, Senders senders) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (int status = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
      status != 0)
    return Error{status == EAI_AGAIN ? Code::NotFound : Code::Invalid,
                 "host \"" + host + "\": " + ::gai_strerror(status)};
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, ::freeaddrinfo);
  const std::string where = "UDP port " + std::to_string(port) + " of " + host;
  Descriptor owned(::socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!owned) return failed(where);
  const int socket = owned.get();
  HeadTracker tracker(std::move(owned), port, std::move(senders));
  // No SO_REUSEADDR, which would let a second program steal the packets.
  if (::bind(socket, found->ai_addr, found->ai_addrlen) != 0) return failed(where);
  const int on = 1;
  if (::setsockopt(socket, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0) return failed(where);
  tracker.port_ = port_of(socket);
  return tracker;
}

Result<std::optional<TimedHeadPose>> HeadTracker::receive(MonotonicTime now,
                                                          const Problem& problem) {
  senders_.begin();
  std::optional<TimedHeadPose> newest;
  for (int i = 0; i < kMostAtOnce; ++i) {
    std::array<std::byte, kHeadPacketBytes + 1> bytes{};
    alignas(cmsghdr) std::array<char, 256> control{};
    iovec part{bytes.data(), bytes.size()};
    sockaddr_storage from{};
    msghdr message{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = ::recvmsg(socket_.get(), &message, MSG_TRUNC);  // returns the full size
    if (size < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK) break;
      if (errno == EINTR || errno == ECONNREFUSED) continue;
      return failed("recvmsg");
    }
    const auto whole = static_cast<std::size_t>(size);
    auto pose = whole > bytes.size()
                    ? Result<HeadPose>(
                          Error{Code::Malformed, "a packet of " + std::to_string(whole) + " bytes"})
                    : read_head_packet(std::span(bytes).first(whole));
    if (!pose)
      problem("invalid packet", "ignored " + pose.error().detail);
    else if (auto status = senders_.admit(from, now); !status)
      problem("packet of another", "ignored a packet of " + status.error().detail);
    else
      newest = TimedHeadPose{*pose, arrival(message)};
  }
  return newest;
}

}  // namespace hc
