// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ends of tcp and unix links that connect, with `wait` and `reconnect`. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>
#include <hc/link/stream/dialing_source.h>

namespace hc::internal {

/// A connection to a peer that listens, waiting for it as long as `wait` says.
///
/// Errors: Invalid, Closed (nobody listens), Stopped, System.
Result<Descriptor> connect_now(const Peer& peer, const Uri& uri, const LinkOptions& options);

/// Ends of a link to a peer that listens. With `reconnect` they are there at once, and the
/// connection when it can be had; else they have it from connect_now(). Errors: the same.
Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options);
/// The same, of what is made of each connection.
Result<std::unique_ptr<Source>> dial_source(const Peer& peer, const Uri& uri,
                                            const LinkOptions& options, DialingSource::Made made);
Result<std::unique_ptr<Sink>> dial_sink(const Peer& peer, const Uri& uri,
                                        const LinkOptions& options);

}  // namespace hc::internal
