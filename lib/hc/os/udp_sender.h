// SPDX-License-Identifier: Apache-2.0
#pragma once
// The user of this host that sent a UDP packet.

#include <sys/socket.h>
#include <sys/types.h>

#include <optional>

#include <hc/base/result.h>

namespace hc {

/// The user whose socket sent a UDP packet from this address; nullopt if the address is of another
/// host. If sockets of several users share the address, a user other than this process's is
/// returned.
///
/// Errors: NotFound (the socket has been closed). Cost: reads all UDP sockets of this host.
Result<std::optional<uid_t>> udp_sender_user(const sockaddr_storage& from);

}  // namespace hc
