// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ends of links that connect, with `wait` and `reconnect`. Internal.

#include <functional>
#include <memory>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>

namespace hc::internal {

/// A connection to a peer that listens, waiting for it as long as `wait` says.
///
/// Errors: Invalid, Closed (nobody listens), Stopped, System.
Result<ConnectedSocket> connect_now(const Peer& peer, const Uri& uri, const LinkOptions& options);

/// What becomes of the connections of a source.
struct Made {
  /// Makes the source of a connection; if that fails, the connection counts as lost.
  std::function<Result<std::unique_ptr<Source>>(ConnectedSocket connection)> open;
  int wake_descriptor = -1;  ///< of all sources that come of it
};

/// Ends of a link to a peer that listens. Without `reconnect` they have their connection from
/// connect_now(), with the same errors.
///
/// With it they are there at once, and the connection when it can be had; a source connects again
/// when that is lost, until the dialer gives up; then it ends, or fails with NotFound if there
/// never was a connection. A partly received message is dropped: the peer sends it again, whole, or
/// not at all. A clean close looks like the end of a killed process, so both lead to reconnecting.
Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options, Made made);
/// The same, of messages as they stand in the stream.
Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options);
Result<std::unique_ptr<Sink>> dial_sink(const Peer& peer, const Uri& uri,
                                        const LinkOptions& options);

}  // namespace hc::internal
