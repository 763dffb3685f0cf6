// SPDX-License-Identifier: Apache-2.0
// Sockets that listen already, held for a program by who starts it (spec/module.md, section 4).
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cstdlib>
#include <cstring>
#include <sstream>

#include <hc/link/stream/ends.h>

namespace hc::internal {

Descriptor held_for_us(const Address& address) {
  const char* numbers = std::getenv(kListeners);
  std::istringstream words(numbers == nullptr ? "" : numbers);
  for (int number = -1; words >> number;) {
    sockaddr_un place{};
    socklen_t size = sizeof place;
    if (::getsockname(number, reinterpret_cast<sockaddr*>(&place), &size) != 0 ||
        size != address.size || std::memcmp(&place, address.get(), size) != 0)
      continue;
    ::fcntl(number, F_SETFD, FD_CLOEXEC);  // is not for what this program starts
    return Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, 0));
  }
  return {};
}

}  // namespace hc::internal
