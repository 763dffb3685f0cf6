// SPDX-License-Identifier: Apache-2.0
#include <drivers/head_tracker/sender.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>

#include <hc/base/uri.h>

namespace hc {
namespace {

Error not_sent(const std::string& what) {
  return {Code::System, what + ": " + std::generic_category().message(errno)};
}

}  // namespace

Result<HeadPoseSender> HeadPoseSender::open(const std::string& address) {
  const auto place = parse_host_port(address);
  if (!place) return place.error();
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return not_sent("socket");
  HeadPoseSender sender(socket);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(place->port);
  if (place->port == 0 || ::inet_pton(AF_INET, place->host.c_str(), &to.sin_addr) != 1)
    return Error{Code::Invalid, "\"" + address + "\" is no address and port of IPv4"};
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
    return not_sent("UDP " + address);
  return sender;
}

HeadPoseSender::HeadPoseSender(HeadPoseSender&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)) {}

HeadPoseSender::~HeadPoseSender() {
  if (socket_ >= 0) ::close(socket_);
}

Result<void> HeadPoseSender::send(const HeadPose& pose) {
  const auto packet = write_head_packet(pose);
  if (::send(socket_, packet.data(), packet.size(), 0) >= 0) return {};
  // ECONNREFUSED is of an earlier packet that nobody received.
  if (errno == ECONNREFUSED || errno == EAGAIN || errno == EINTR) return {};
  return not_sent("send");
}

}  // namespace hc
