// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stream sockets by URI, for the transports that are made of them. Internal.

#include <sys/types.h>

#include <string>

#include <hc/base/uri.h>
#include <hc/link/stream/dialer.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// Who listens at `tcp:HOST:PORT` or `unix:PATH`, to be connected to. With `same_user=1` a TCP peer
/// is only of this user or root. Errors: Invalid, NotFound.
Result<Peer> tcp_peer(const Uri& uri);
Result<Peer> unix_peer(const Uri& uri);

/// The same of `tls:HOST:PORT`, and who listens at `tls-listen:[HOST:]PORT`. They are in lib/tls,
/// and null in programs that are linked without it.
[[gnu::weak]] Result<Peer> tls_peer(const Uri& uri);
[[gnu::weak]] Result<ListeningSocket> listen_tls(const Uri& uri);

/// A socket that listens at `tcp-listen:[HOST:]PORT`, on loopback without a host;
/// `same_user` as above. Errors: Invalid, NotFound, System.
Result<ListeningSocket> listen_tcp(const Uri& uri);
/// A socket that listens at `unix-listen:PATH` or `unix-listen:@NAME`; of those that connect to a
/// @NAME only processes of this user are let in. Errors: Invalid, System.
Result<ListeningSocket> listen_unix(const Uri& uri);

/// "another user (uid 1000)" where a connection's other side is of another user, but for root, who
/// may do all; empty where it is not.
std::string foreigner(int socket);
/// The same of a user.
std::string foreigner_of(uid_t user);

}  // namespace hc::internal
