// SPDX-License-Identifier: Apache-2.0
#include <tls/transport.h>

#include <hc/link/stream/ends.h>
#include <tls/acceptor.h>
#include <tls/channel.h>
#include <tls/context.h>

namespace hc::tls {

Result<internal::Peer> find_peer(const Uri& uri) {
  auto context = HC_TRY(Context::make(uri));
  auto peer = internal::tcp_peer(uri);
  if (!peer) return peer;
  peer->secure = [own = context](int socket) {
    return std::make_unique<TlsChannel>(own, socket, TlsChannel::Side::Dials);
  };
  return peer;
}

Result<ListeningSocket> listen(const Uri& uri, const LogSink& log) {
  auto context = HC_TRY(Context::make(uri));
  auto listening = internal::listen_tcp(uri, log);
  if (!listening) return listening;
  auto acceptor = std::make_shared<Acceptor>(std::move(*listening), std::move(context));
  auto readable = HC_TRY(acceptor->start());
  ListeningSocket socket;
  socket.descriptor = std::move(readable);
  socket.take_agreed = [acceptor](const LogSink& log) { return acceptor->take(log); };
  return socket;
}

void add_transports() {
  const auto check = [](const Uri& uri) {
    auto place = internal::check_host_port(uri);
    return place ? check_keys(uri) : place;
  };
  add_transport(internal::dialing<find_peer>("tls", "key peer", check));
  add_transport(internal::listening<listen>("tls-listen", "key peer", check));
}

}  // namespace hc::tls
