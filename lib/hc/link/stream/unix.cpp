// SPDX-License-Identifier: Apache-2.0
// `unix:PATH` and `unix-listen:PATH`: between processes of one host. `@NAME` is in the abstract
// namespace: it leaves no file, and accepts only processes of the same user.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <hc/link/stream/ends.h>
#include <hc/os/peer_user.h>

namespace hc::internal {
namespace {

bool is_abstract(const Uri& uri) {
  return uri.rest.starts_with('@');
}

Result<Address> address_of(const Uri& uri) {
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  // A path ends with a NUL; an abstract name begins with one in place of its @.
  if (uri.rest.empty() || uri.rest.size() >= sizeof place.sun_path)
    return Error{Code::Invalid, "a Unix socket's path has 1 to " +
                                    std::to_string(sizeof place.sun_path - 1) + " bytes: \"" +
                                    uri.rest + "\""};
  std::copy(uri.rest.begin(), uri.rest.end(), place.sun_path);
  if (is_abstract(uri)) place.sun_path[0] = '\0';
  return Address(&place, static_cast<unsigned>(offsetof(sockaddr_un, sun_path) + uri.rest.size() +
                                               (is_abstract(uri) ? 0 : 1)));
}

/// Whether the file of a socket was left behind by a process that was killed. Tried with a datagram
/// socket, which a listener does not notice; a stream connection would count as its first reader.
bool is_left_behind(const Uri& uri, const Address& address) {
  Descriptor probe(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (::connect(probe.get(), address.get(), address.size) == 0 || errno != ECONNREFUSED)
    return false;
  struct stat status {};
  return ::stat(uri.rest.c_str(), &status) == 0 && S_ISSOCK(status.st_mode);
}

/// Checks the user of each connection to an abstract name, since it has no file permissions.
std::function<Status(int)> admission(const Uri& uri, const char* what) {
  if (!is_abstract(uri)) return {};
  return [what](int socket) { return check_own(unix_peer_user(socket), what); };
}

/// Duplicates the inherited socket that listens at an address (spec/module.md, section 4), if any.
Descriptor held_for_us(const Address& address) {
  const char* numbers = std::getenv(kListeners);
  std::istringstream words(numbers == nullptr ? "" : numbers);
  for (int number = -1; words >> number;) {
    sockaddr_un place{};
    socklen_t size = sizeof place;
    if (::getsockname(number, reinterpret_cast<sockaddr*>(&place), &size) != 0 ||
        size != address.size || std::memcmp(&place, address.get(), size) != 0)
      continue;
    ::fcntl(number, F_SETFD, FD_CLOEXEC);  // not for child processes
    return Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, 0));
  }
  return {};
}

}  // namespace

Result<Peer> unix_peer(const Uri& uri) {
  auto address = HC_TRY(address_of(uri));
  Peer peer;
  peer.name = uri.rest;
  peer.addresses = {address};
  peer.longest_pause = kLocalPause;
  peer.admit = admission(uri, kListener);
  return peer;
}

Result<ListeningSocket> listen_unix(const Uri& uri, const LogSink& /*log*/) {
  auto address = HC_TRY(address_of(uri));
  if (!is_abstract(uri) && is_left_behind(uri, address)) ::unlink(uri.rest.c_str());
  ListeningSocket socket;
  socket.descriptor = held_for_us(address);
  if (!socket.descriptor) socket.descriptor = HC_TRY(listen_on(address, uri.rest));
  socket.admit = admission(uri, kAccepted);
  if (!is_abstract(uri)) socket.unlink_path = uri.rest;
  return socket;
}

}  // namespace hc::internal
