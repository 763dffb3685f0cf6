// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which user is at the other end of a TCP connection of this host. Internal.

#include <sys/types.h>

#include <hc/base/result.h>

namespace hc::internal {

/// How this end came to its connection.
enum class Connected { Accepted, Dialed };

/// The user whose socket is at the other end of a connection over loopback. While a peer that was
/// dialed has not accepted yet, it is who listens there.
///
/// Errors: NotFound (not over loopback, or the peer has closed its socket meanwhile), System.
Result<uid_t> tcp_peer_user(int socket, Connected how);

}  // namespace hc::internal
