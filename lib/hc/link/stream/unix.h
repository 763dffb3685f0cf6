// SPDX-License-Identifier: Apache-2.0
#pragma once
// Unix sockets by URI, for the transports that are made of them. Internal.

#include <hc/base/uri.h>
#include <hc/link/stream/dialer.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// "another user (uid 1000)" where a connection's other side is of another user, but for root, who
/// may do all; empty where it is not.
std::string foreigner(int socket);

/// A socket that listens at `unix:PATH` or `unix:@NAME`; of those that connect to a @NAME only
/// processes of this user are let in. Errors: Invalid, System.
Result<ListeningSocket> listen_unix(const Uri& uri);

/// Who listens there, to be connected to. Errors: Invalid.
Result<Peer> unix_peer(const Uri& uri);

}  // namespace hc::internal
