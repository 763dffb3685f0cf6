// SPDX-License-Identifier: Apache-2.0
// `tls:HOST:PORT` and `tls-listen:[HOST:]PORT`: tcp links, encrypted, whose two ends know each
// other's keys.
#include <hc/link/stream/ends.h>
#include <tls/acceptor.h>
#include <tls/channel.h>
#include <tls/context.h>

extern "C" {
extern const int kHcTlsTransport;
const int kHcTlsTransport = 0;
}

namespace hc::internal {

Result<Peer> tls_peer(const Uri& uri) {
  auto context = tls::Context::make(uri);
  if (!context) return context.error();
  auto peer = tcp_peer(uri);
  if (!peer) return peer;
  peer->secure = [own = *context](int socket) {
    return std::make_unique<tls::TlsChannel>(own, socket, tls::TlsChannel::Side::Dials);
  };
  return peer;
}

Result<ListeningSocket> listen_tls(const Uri& uri) {
  auto context = tls::Context::make(uri);
  if (!context) return context.error();
  auto listening = listen_tcp(uri);
  if (!listening) return listening;
  auto acceptor = std::make_shared<tls::Acceptor>(std::move(*listening), std::move(*context));
  auto readable = acceptor->start();
  if (!readable) return readable.error();
  ListeningSocket socket;
  socket.descriptor = std::move(*readable);
  socket.take_agreed = [acceptor](const LogSink& log) { return acceptor->take(log); };
  return socket;
}

}  // namespace hc::internal
