// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which user of this host sent a UDP packet.

#include <sys/socket.h>
#include <sys/types.h>

#include <optional>

#include <hc/base/result.h>

namespace hc {

/// The user whose socket sent a UDP packet that came from this address; nothing where the address
/// is another host's. Where several sockets have that address, one of another user counts before
/// those of this process's user.
///
/// Errors: NotFound (the socket is closed meanwhile). Cost: a look at all UDP sockets of this host.
Result<std::optional<uid_t>> udp_sender_user(const sockaddr_storage& from);

}  // namespace hc
