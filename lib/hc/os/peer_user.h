// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which user is at the other end of a connection within this host.

#include <sys/types.h>

#include <string>

#include <hc/base/result.h>

namespace hc {

/// How this end came to its connection.
enum class Connected { Accepted, Dialed };

/// The user whose socket is at the other end of a TCP connection over loopback. Until a peer that
/// was dialed has accepted, it is the user who listens there.
///
/// Errors: NotFound (not over loopback, or the peer has closed its socket meanwhile), System.
Result<uid_t> tcp_peer_user(int socket, Connected how);

/// The same of a Unix socket. Errors: System.
Result<uid_t> unix_peer_user(int socket);

/// Whether a peer is a process of this user, or of root, who may do everything.
/// @param what  begins the error: "refused a peer of another user (uid 1000)". Errors: Closed.
Status check_own(const Result<uid_t>& peer, const std::string& what);

}  // namespace hc
