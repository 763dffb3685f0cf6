// SPDX-License-Identifier: Apache-2.0
// `unix:PATH` and `unix-listen:PATH`: between processes of one host. `@NAME` is in the abstract
// namespace: it leaves no file, and only processes of the same user are let in.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>

#include <hc/link/stream/peers.h>

namespace hc::internal {
namespace {

struct UnixAddress {
  sockaddr_un address{};
  unsigned size = 0;
};

bool is_abstract(const Uri& uri) {
  return uri.rest.starts_with('@');
}

Result<UnixAddress> address_of(const Uri& uri) {
  UnixAddress result;
  result.address.sun_family = AF_UNIX;
  // A path ends with a NUL; an abstract name begins with one in place of its @.
  if (uri.rest.empty() || uri.rest.size() >= sizeof result.address.sun_path)
    return Error{Code::Invalid, "a Unix socket's path has 1 to " +
                                    std::to_string(sizeof result.address.sun_path - 1) +
                                    " bytes: \"" + uri.rest + "\""};
  std::copy(uri.rest.begin(), uri.rest.end(), result.address.sun_path);
  if (is_abstract(uri)) result.address.sun_path[0] = '\0';
  result.size = static_cast<unsigned>(offsetof(sockaddr_un, sun_path) + uri.rest.size() +
                                      (is_abstract(uri) ? 0 : 1));
  return result;
}

/// Whether a socket's file was left behind by a process that was killed: nobody has it bound.
///
/// Asked with a socket of the other kind, of which a listener never learns; a connection would
/// take the place of its first reader.
bool is_left_behind(const UnixAddress& address) {
  Descriptor probe(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const auto* place = reinterpret_cast<const sockaddr*>(&address.address);
  if (::connect(probe.get(), place, address.size) == 0 || errno != ECONNREFUSED) return false;
  struct stat status {};
  return ::stat(address.address.sun_path, &status) == 0 && S_ISSOCK(status.st_mode);
}

}  // namespace

// An abstract name has no permissions of its own.
std::string foreigner(int socket) {
  ucred credentials{};
  socklen_t size = sizeof credentials;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &credentials, &size) != 0)
    return "a user that the kernel does not tell";
  return foreigner_of(credentials.uid);
}

std::string foreigner_of(uid_t user) {
  if (user == ::geteuid() || user == 0) return "";
  return "another user (uid " + std::to_string(user) + ")";
}

namespace {

/// What lets this user in alone, and says so of others.
std::function<Status(int)> refuser(std::string_view what) {
  return [what](int socket) -> Status {
    auto who = foreigner(socket);
    if (who.empty()) return {};
    return Error{Code::Closed, std::string(what) + who};
  };
}

}  // namespace

Result<Peer> unix_peer(const Uri& uri) {
  auto address = address_of(uri);
  if (!address) return address.error();
  Peer peer;
  peer.name = uri.rest;
  peer.addresses.emplace_back(&address->address, address->size);
  peer.longest_pause = kLocalPause;
  if (is_abstract(uri)) peer.admit = refuser("the listener is a process of ");
  return peer;
}

Result<ListeningSocket> listen_unix(const Uri& uri) {
  auto address = address_of(uri);
  if (!address) return address.error();
  ListeningSocket socket;
  if (is_abstract(uri))
    socket.admit = refuser("refused a peer of ");
  else if (is_left_behind(*address))
    ::unlink(uri.rest.c_str());
  auto descriptor = listen_on({&address->address, address->size}, uri.rest);
  if (!descriptor) return descriptor.error();
  socket.descriptor = std::move(*descriptor);
  if (!is_abstract(uri)) socket.unlink_path = uri.rest;
  return socket;
}

}  // namespace hc::internal
