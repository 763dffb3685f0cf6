// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/sender.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <string>

#include <hc/base/uri.h>

namespace hc {
namespace {

Error not_sent(const std::string& what) {
  return {Code::System, what + ": " + std::strerror(errno)};
}

}  // namespace

Result<HeadPoseSender> HeadPoseSender::open(const std::string& address) {
  const auto place = HC_TRY(parse_host_port(address));
  HeadPoseSender sender(
      Descriptor(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)));
  if (!sender.socket_) return not_sent("socket");
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(place.port);
  if (place.port == 0 || ::inet_pton(AF_INET, place.host.c_str(), &to.sin_addr) != 1)
    return Error{Code::Invalid, "\"" + address + "\" is not an IPv4 address and port"};
  if (::connect(sender.socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    return not_sent("UDP " + address);
  return sender;
}

Result<void> HeadPoseSender::send(const HeadPose& pose) {
  const auto packet = write_head_packet(pose);
  if (::send(socket_.get(), packet.data(), packet.size(), 0) >= 0) return {};
  // ECONNREFUSED reports that an earlier packet had no receiver.
  if (errno == ECONNREFUSED || errno == EAGAIN || errno == EINTR) return {};
  return not_sent("send");
}

}  // namespace hc
