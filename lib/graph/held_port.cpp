// SPDX-License-Identifier: Apache-2.0
#include <graph/held_port.h>

#include <netinet/in.h>

#include <string>

#include <hc/os/socket.h>

namespace hc {

Result<std::shared_ptr<const HeldPort>> hold_port(bool of_all_addresses, std::uint16_t number) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(number);
  place.sin_addr.s_addr = htonl(of_all_addresses ? INADDR_ANY : INADDR_LOOPBACK);
  const Address address(&place, sizeof place);
  auto socket = HC_TRY(bind_socket(
      address, (of_all_addresses ? "0.0.0.0:" : "127.0.0.1:") + std::to_string(number)));
  socklen_t size = sizeof place;
  HC_TRY(system_call("getsockname", "", [&] {
    return ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&place), &size);
  }));
  return std::make_shared<const HeldPort>(HeldPort{std::move(socket), ntohs(place.sin_port)});
}

}  // namespace hc
