// SPDX-License-Identifier: Apache-2.0
#pragma once
// Access control for a tracker's UDP port, since UDP has neither connections nor passwords.

#include <sys/socket.h>
#include <sys/types.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <hc/base/turn.h>
#include <hc/os/udp_sender.h>

namespace hc {

/// Accepts processes of this user and of root on this host, and listed hosts; one sender at a time,
/// until it is silent. For one thread.
class Senders {
 public:
  /// Returns the user of a local address, nothing for another host.
  using UserOf = std::function<Result<std::optional<uid_t>>(const sockaddr_storage& from)>;

  /// @param hosts  addresses of other accepted hosts, "192.168.1.7".
  /// @param silence  after which another sender is accepted.
  Senders(std::vector<std::string> hosts, std::chrono::nanoseconds silence,
          UserOf user_of = udp_sender_user)
      : hosts_(std::move(hosts)), user_of_(std::move(user_of)), turn_(silence) {}

  /// Starts a batch of packets: looks up users again, since addresses may have changed hands.
  void begin() { known_.clear(); }
  /// Whether to accept a packet from this address.
  ///
  /// Errors: Closed (another user, a host not listed, another sender is active).
  /// Cost: one look-up in the host's sockets per address since begin(), at most eight.
  Status admit(const sockaddr_storage& from, MonotonicTime now);

 private:
  struct Known {
    std::string address;
    Status status;
  };
  Status check(const sockaddr_storage& from, const std::string& host, const std::string& address);

  std::vector<std::string> hosts_;
  UserOf user_of_;
  Turn<std::string> turn_;
  std::vector<Known> known_;
};

}  // namespace hc
