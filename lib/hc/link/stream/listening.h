// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ends of tcp and unix links that listen: any number of peers come and go. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// How many peers a listening end has at once.
constexpr std::size_t kMaxPeers = 256;

/// Takes messages from all peers that connect, in the order in which they come. A peer that breaks
/// a rule is closed, which is logged; the others notice nothing. Never ends on its own.
///
/// When there are kMaxPeers, the one whose last message was longest ago makes room for who comes,
/// unless it is inside a message: so peers that say nothing cannot keep others out.
///
/// Errors: System.
Result<std::unique_ptr<Source>> listening_source(ListeningSocket socket,
                                                 const LinkOptions& options);

/// Puts each message to every peer that is connected, each by a Connection of its own: with another
/// policy than keep=all none waits for another. The URI's options say the readers and the policy.
///
/// Waits for the first readers; peers that leave are forgotten, and those that come later receive
/// what is sent from then on. When all have left, it waits for another; but if readers were counted
/// the link is closed, or stays: then only a policy that loses nothing waits for another. With a
/// count of 0 it never waits for a reader, and what is sent without one is lost.
///
/// Errors: Invalid, System.
Result<std::unique_ptr<Sink>> listening_sink(ListeningSocket socket, const Uri& uri,
                                             const LinkOptions& options);

}  // namespace hc::internal
