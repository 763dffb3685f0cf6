// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages into any descriptor that carries a stream of bytes. Internal: what stdio, file, tcp and
// unix share.

#include <memory>

#include <hc/link/link.h>
#include <hc/link/stream/dialer.h>

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

}  // namespace hc::internal
