// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ends of stream links, and their sockets: ends that connect, with `wait` and `reconnect`, and
// ends that listen, with any number of peers. Internal. source.h reads messages from one stream.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>
#include <hc/link/transport.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// Writes messages to one stream, by a Connection.
///
/// A partly written message is finished even after `stop`.
///
/// @param descriptor  non-blocking, unless it is a socket. May be none (-1) with a dialer, which
///     reconnects when the connection is lost.
/// @param uri  says the policy.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Sink>> make_stream_sink(ConnectedSocket descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer = nullptr);

/// Connects to a peer that listens, waiting for it as long as the option `wait` says.
///
/// Errors: Invalid, NotFound (unknown name), Closed (no peer listens), Stopped, System.
Result<ConnectedSocket> connect_now(const Peer& peer, const Uri& uri, const LinkOptions& options);

/// How dial_source() makes sources of connections.
struct Made {
  /// Makes the source of a connection; if it fails, the connection counts as lost. Empty: a
  /// StreamSource.
  std::function<Result<std::unique_ptr<Source>>(ConnectedSocket connection)> open = {};
  int wake_descriptor = -1;  ///< of all sources made
};

/// Ends of a link to a peer that listens. Without the option `reconnect` they connect by
/// connect_now(), with the same errors.
///
/// With it they return at once, connect in the background, and reconnect when the connection is
/// lost or closed, until the dialer gives up; then a source ends, or fails with NotFound if it was
/// never connected. A partly received message is dropped, and may be sent again.
Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options, Made made = {});
Result<std::unique_ptr<Sink>> dial_sink(const Peer& peer, const Uri& uri,
                                        const LinkOptions& options);

/// The most peers that a listening end has at once.
constexpr std::size_t kMaxPeers = 256;

/// Time limits for the peers of a listening source.
struct PeerTimes {
  std::chrono::seconds header{5};  ///< for a complete header, from its first bytes; then it closes
  std::chrono::seconds silence{30};  ///< inside a message, if a new peer waits to connect
};

/// Takes messages from all peers that connect, in the order of arrival. A peer that sends an
/// invalid message is closed, which is logged; the others are not affected. Never ends by itself.
///
/// When there are kMaxPeers, a new peer replaces the one that has been silent longest, so that
/// silent peers cannot lock others out; one inside a message only after PeerTimes::silence.
///
/// Errors: System.
Result<std::unique_ptr<Source>> listening_source(ListeningSocket socket, const LinkOptions& options,
                                                 PeerTimes times = {});

/// Sends each message to every connected peer, each over its own Connection, so that a slow peer
/// delays the others only with keep=all. The options `readers`, `stay` and `wait` are those of
/// Audience.
///
/// While it sends, it looks once a millisecond for peers that have connected or left. New peers
/// receive the messages sent after that. A peer that has left is also noticed by the first write
/// that fails; messages sent before are lost with it.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Sink>> listening_sink(ListeningSocket socket, const Uri& uri,
                                             const LinkOptions& options);

/// How errors about the user of a peer begin.
inline constexpr const char* kListener = "the listener is a process of ";
inline constexpr const char* kAccepted = "refused a peer of ";

/// The peer that listens at `tcp:HOST:PORT` or `unix:PATH`. With `same_user=1` a TCP peer must
/// belong to this user or root. Errors: Invalid.
Result<Peer> tcp_peer(const Uri& uri);
Result<Peer> unix_peer(const Uri& uri);

/// A socket that listens at `tcp-listen:[HOST:]PORT`, by default on loopback; `same_user` as
/// above. Logs if this host does not have the address yet. Errors: Invalid, NotFound, System.
Result<ListeningSocket> listen_tcp(const Uri& uri, const LogSink& log);
/// A socket that listens at `unix-listen:PATH` or `unix-listen:@NAME`; a @NAME accepts only
/// processes of this user or root. Uses the socket in kListeners with this name, if any. Errors:
/// Invalid, System.
Result<ListeningSocket> listen_unix(const Uri& uri, const LogSink& log = {});

/// The environment variable with the numbers of inherited sockets that already listen at @NAMEs,
/// separated by blanks.
inline constexpr const char* kListeners = "HC_LISTENERS";

/// Errors: Invalid (not `[HOST:]PORT`).
Status check_host_port(const Uri& uri);

/// The options of a Policy, which all sinks have.
inline constexpr const char* kPolicyOptions = "keep rate burst bandwidth memory timeout";

/// The transport whose ends connect to the peer from `find`.
/// @param options  in addition to those of all such transports.
template <Result<Peer> find(const Uri&)>
Transport dialing(std::string scheme, const std::string& options, Status (*check)(const Uri&)) {
  const std::string all = "wait reconnect " + options;
  return {std::move(scheme),
          all,
          all + " " + kPolicyOptions,
          [](const Uri& uri, const LinkOptions& link) -> Result<std::unique_ptr<Source>> {
            auto peer = find(uri);
            return peer ? dial_source(*peer, uri, link) : peer.error();
          },
          [](const Uri& uri, const LinkOptions& link) -> Result<std::unique_ptr<Sink>> {
            auto peer = find(uri);
            return peer ? dial_sink(*peer, uri, link) : peer.error();
          },
          check};
}

/// The transport whose ends listen on the socket from `listen`.
template <Result<ListeningSocket> listen(const Uri&, const LogSink&)>
Transport listening(std::string scheme, const std::string& options, Status (*check)(const Uri&)) {
  return {std::move(scheme),
          options,
          "readers stay wait " + options + " " + kPolicyOptions,
          [](const Uri& uri, const LinkOptions& link) -> Result<std::unique_ptr<Source>> {
            auto socket = listen(uri, link.log);
            return socket ? listening_source(std::move(*socket), link) : socket.error();
          },
          [](const Uri& uri, const LinkOptions& link) -> Result<std::unique_ptr<Sink>> {
            auto socket = listen(uri, link.log);
            return socket ? listening_sink(std::move(*socket), uri, link) : socket.error();
          },
          check};
}

}  // namespace hc::internal
