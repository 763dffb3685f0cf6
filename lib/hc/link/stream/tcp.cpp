// SPDX-License-Identifier: Apache-2.0
// `tcp:HOST:PORT` and `tcp-listen:[HOST:]PORT`: between hosts, and to netcat.
#include <netdb.h>

#include <memory>
#include <string>
#include <vector>

#include <hc/link/stream/ends.h>
#include <hc/os/peer_user.h>

namespace hc::internal {
namespace {

/// The addresses of a host, 127.0.0.1 if none is given. Errors: NotFound.
Found look_up(const HostPort& place, int flags) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* list = nullptr;
  const std::string port = std::to_string(place.port);
  const char* host = place.host.empty() ? "127.0.0.1" : place.host.c_str();
  const int status = ::getaddrinfo(host, port.c_str(), &hints, &list);
  if (status != 0) return Error{Code::NotFound, std::string(host) + ": " + ::gai_strerror(status)};
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owned(list, ::freeaddrinfo);
  std::vector<Address> addresses;
  for (const addrinfo* each = list; each != nullptr; each = each->ai_next)
    addresses.emplace_back(each->ai_addr, each->ai_addrlen);
  return addresses;
}

/// Checks the user of each connection if `same_user=1`, else empty. Errors: Invalid.
Result<std::function<Status(int)>> admission(const Uri& uri, Connected how, const char* what) {
  auto same_user = HC_TRY(number_option(uri, "same_user", 0, {0, 1}));
  if (same_user == 0) return std::function<Status(int)>();
  return std::function([=](int socket) { return check_own(tcp_peer_user(socket, how), what); });
}

}  // namespace

Status check_host_port(const Uri& uri) {
  HC_TRY(parse_host_port(uri.rest));
  return {};
}

/// A name may have several addresses; localhost has two.
Result<Peer> tcp_peer(const Uri& uri) {
  const auto place = HC_TRY(parse_host_port(uri.rest));
  Peer peer;
  peer.name = uri.rest;
  peer.admit = HC_TRY(admission(uri, Connected::Dialed, kListener));
  if (peer.admit) peer.longest_pause = kLocalPause;
  if (auto known = look_up(place, AI_NUMERICHOST))
    peer.addresses = std::move(*known);
  else
    peer.find = [place] { return look_up(place, 0); };
  return peer;
}

Result<ListeningSocket> listen_tcp(const Uri& uri, const LogSink& log) {
  const auto place = HC_TRY(parse_host_port(uri.rest));
  const auto addresses = HC_TRY(look_up(place, AI_PASSIVE));
  ListeningSocket socket;
  socket.admit = HC_TRY(admission(uri, Connected::Accepted, kAccepted));
  socket.descriptor = HC_TRY(listen_on(addresses.front(), uri.rest));
  if (log && !is_of_this_host(addresses.front())) log(Level::Warning, kNotOfThisHost);
  return socket;
}

}  // namespace hc::internal
