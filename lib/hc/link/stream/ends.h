// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ends of links that are streams of bytes, and the sockets that carry them: ends that connect,
// with `wait` and `reconnect`, and those that listen, with any number of peers that come and go.
// Internal. source.h is the end of one stream where messages come out.

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>
#include <hc/link/transport.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// Puts messages into one stream, by a Connection.
///
/// A message that was begun is finished, also when it is to stop: the reader could not tell where
/// the next one begins, and would call the stream damaged.
///
/// @param descriptor  its writes do not wait; those of sockets never do. May be none (-1) with a
///     dialer, which connects again when the connection is lost.
/// @param uri  for its policy.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Sink>> make_stream_sink(ConnectedSocket descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer = nullptr);

/// A connection to a peer that listens, waiting for it as long as `wait` says.
///
/// Errors: Invalid, Closed (nobody listens), Stopped, System.
Result<ConnectedSocket> connect_now(const Peer& peer, const Uri& uri, const LinkOptions& options);

/// What a connecting source makes of its connections.
struct Made {
  /// Makes the source of a connection; if that fails, the connection counts as lost. Empty: one of
  /// the messages in the stream.
  std::function<Result<std::unique_ptr<Source>>(ConnectedSocket connection)> open = {};
  int wake_descriptor = -1;  ///< of all these sources
};

/// Ends of a link to a peer that listens. Without `reconnect` they have their connection from
/// connect_now(), with the same errors.
///
/// With it they exist at once, and their connection as soon as possible; a source connects again
/// when that is lost, until the dialer gives up; then it ends, or fails with NotFound if there
/// never was a connection. A partly received message is dropped: the peer sends it again, whole, or
/// not at all. A clean close looks like the end of a killed process, so both lead to reconnecting.
Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options, Made made = {});
Result<std::unique_ptr<Sink>> dial_sink(const Peer& peer, const Uri& uri,
                                        const LinkOptions& options);

/// How many peers a listening end has at once.
constexpr std::size_t kMaxPeers = 256;

/// How long a peer of a listening source may take.
struct PeerTimes {
  std::chrono::seconds header{5};  ///< for a whole header, from its first bytes; then it is closed
  std::chrono::seconds silence{30};  ///< inside a message, when another waits for its place
};

/// Takes messages from all peers that connect, in the order of arrival. A peer that breaks a rule
/// is closed, which is logged; the others are not affected. Never ends by itself.
///
/// When there are kMaxPeers, a new one replaces the peer with the longest silence, so that silent
/// peers do not lock others out. A peer inside a message is replaced only after PeerTimes::silence.
///
/// Errors: System.
Result<std::unique_ptr<Source>> listening_source(ListeningSocket socket, const LinkOptions& options,
                                                 PeerTimes times = {});

/// Sends each message to every peer that is connected, each by a Connection of its own: with
/// another policy than keep=all none waits for another. The URI's options say the readers and the
/// policy.
///
/// Waits for the first readers; peers that leave are dropped, and new ones receive what is sent
/// from then on. When all have left, it waits for another; but if readers were counted the link is
/// closed, or stays: then only a policy that loses nothing waits for another. With a count of 0 it
/// never waits for a reader, and what is sent without one is lost.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Sink>> listening_sink(ListeningSocket socket, const Uri& uri,
                                             const LinkOptions& options);

/// How an error about the user of a peer begins.
inline constexpr const char* kListener = "the listener is a process of ";
inline constexpr const char* kAccepted = "refused a peer of ";

/// Who listens at `tcp:HOST:PORT` or `unix:PATH`, to be connected to. With `same_user=1` a TCP peer
/// is only of this user or root. Errors: Invalid, NotFound.
Result<Peer> tcp_peer(const Uri& uri);
Result<Peer> unix_peer(const Uri& uri);

/// A socket that listens at `tcp-listen:[HOST:]PORT`, on loopback without a host;
/// `same_user` as above. Errors: Invalid, NotFound, System.
Result<ListeningSocket> listen_tcp(const Uri& uri);
/// A socket that listens at `unix-listen:PATH` or `unix-listen:@NAME`; connections to a @NAME are
/// accepted from processes of this user or root only. A socket of kListeners that has the name is
/// used. Errors: Invalid, System.
Result<ListeningSocket> listen_unix(const Uri& uri);

/// Names the variable of the environment with the numbers of sockets that listen already at @NAMEs,
/// separated by blanks: whoever starts a program holds them for it.
inline constexpr const char* kListeners = "HC_LISTENERS";

/// Errors: Invalid (not `[HOST:]PORT`).
Status check_host_port(const Uri& uri);

/// The options of a Policy, which every sink has.
inline constexpr const char* kPolicyOptions = "keep rate burst memory timeout";

/// The transport whose ends connect to the peer that `find` gives.
/// @param options  that it has beside those of each such transport.
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

/// The transport whose ends listen with the socket that `listen` gives.
template <Result<ListeningSocket> listen(const Uri&)>
Transport listening(std::string scheme, const std::string& options, Status (*check)(const Uri&)) {
  return {std::move(scheme),
          options,
          "readers stay wait " + options + " " + kPolicyOptions,
          [](const Uri& uri, const LinkOptions& link) -> Result<std::unique_ptr<Source>> {
            auto socket = listen(uri);
            return socket ? listening_source(std::move(*socket), link) : socket.error();
          },
          [](const Uri& uri, const LinkOptions& link) -> Result<std::unique_ptr<Sink>> {
            auto socket = listen(uri);
            return socket ? listening_sink(std::move(*socket), uri, link) : socket.error();
          },
          check};
}

}  // namespace hc::internal
