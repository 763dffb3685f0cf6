// SPDX-License-Identifier: Apache-2.0
#pragma once
// The user at the other end of a connection within this host.

#include <sys/types.h>

#include <string>

#include <hc/base/result.h>

namespace hc {

enum class Connected { Accepted, Dialed };

/// The user that owns the other end of a TCP connection over loopback; until a dialed peer has
/// accepted, the user that listens there.
///
/// Errors: NotFound (not over loopback, or the peer has closed its socket), System.
Result<uid_t> tcp_peer_user(int socket, Connected how);

/// The user that owns the other end of a Unix socket. Errors: System.
Result<uid_t> unix_peer_user(int socket);

/// Checks that a peer runs as this user or as root.
/// @param what  begins the error: "refused a peer of another user (uid 1000)". Errors: Closed.
Status check_own(const Result<uid_t>& peer, const std::string& what);

}  // namespace hc
