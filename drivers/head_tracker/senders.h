// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who is heard of all that send packets to a tracker's port: UDP has no connections and no
// password.

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

/// Hears processes of this user and of root on this host, and the hosts that are named; one sender
/// at a time, until it is silent. For one thread.
class Senders {
 public:
  /// Gives the user of an address, nothing for one of another host.
  using UserOf = std::function<Result<std::optional<uid_t>>(const sockaddr_storage& from)>;

  /// @param hosts  addresses of other hosts that are heard, "192.168.1.7".
  /// @param silence  a sender that is silent for longer makes room for another.
  Senders(std::vector<std::string> hosts, std::chrono::nanoseconds silence,
          UserOf user_of = udp_sender_user)
      : hosts_(std::move(hosts)), user_of_(std::move(user_of)), turn_(silence) {}

  /// Begins to handle the packets that have come, which ends what is known of users: another
  /// process may have an address by now.
  void begin() { known_.clear(); }
  /// Whether the packet that came from this address is heard.
  ///
  /// Errors: Closed (another user, a host that is not named, another sender has the turn).
  /// Cost: of each address since begin() a look at the host's sockets, for at most eight of them.
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
