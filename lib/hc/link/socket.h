// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stream sockets, TCP and Unix alike: connected, listening, and their peers. Internal.

#include <chrono>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include <hc/link/descriptor.h>
#include <hc/link/link.h>

namespace hc::internal {

/// A socket that listens, and what is to be cleaned up when it stops.
struct ListeningSocket {
  Descriptor descriptor;
  /// Whether a peer that was accepted is wanted; an error says why not. May be empty.
  std::function<Status(int peer)> admit;
  std::string unlink_path;  ///< removed at the end; empty: nothing

  ListeningSocket() = default;
  ListeningSocket(ListeningSocket&&) = default;
  ListeningSocket& operator=(ListeningSocket&& other) noexcept {
    std::swap(descriptor, other.descriptor);
    admit.swap(other.admit);
    unlink_path.swap(other.unlink_path);
    return *this;
  }
  ~ListeningSocket();
};

/// Where a peer may listen; the memory is somebody else's.
struct Address {
  const void* data = nullptr;  ///< a sockaddr of some family
  unsigned size = 0;           ///< [byte]
};

/// How long a peer may take to answer when one does not wait for it to begin listening.
constexpr std::chrono::seconds kAnswerTime{4};

/// Connects to the first of a name's addresses where somebody listens; tries all of them again,
/// with growing pauses, while nobody does and `wait` has not passed.
///
/// Gives up when `wait` has passed, or kAnswerTime if `wait` is 0; addresses that do not answer
/// share that time. Errors: Closed (refused, or no answer, to the end), Stopped, System.
Result<Descriptor> connect_to(std::span<const Address> addresses, const std::string& name,
                              std::chrono::seconds wait, int stop);

/// A socket that listens on an address; its name is for error lines.
Result<Descriptor> listen_on(const void* address, unsigned size, const std::string& name);

/// Takes the next peer that has connected; none (-1) when there is none just now.
///
/// Errors: System: descriptors or memory have run out, or the network has failed. None is for ever,
/// and who waits may be let in later.
Result<Descriptor> accept_peer(const ListeningSocket& socket, const LinkOptions& options);

}  // namespace hc::internal
