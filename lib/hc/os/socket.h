// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stream sockets, TCP and Unix: connected and listening ones, and their peers.

#include <sys/epoll.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <hc/base/log.h>
#include <hc/os/secure_channel.h>

namespace hc {

/// A listening socket and its clean-up.
struct ListeningSocket {
  Descriptor descriptor;
  /// Whether to admit an accepted peer; the error says why not. May be empty.
  std::function<Status(int peer)> admit;
  /// Replaces accept() for peers that first complete a handshake: returns the next one, none (-1)
  /// if there is none yet, or an error of accept(). `descriptor` is readable when it should be
  /// called. May be empty.
  std::function<Result<ConnectedSocket>(const LogSink& log)> take_agreed;
  std::string unlink_path;  ///< removed on destruction, unless empty
  bool is_paused = false;   ///< a waiting peer could not be accepted

  ListeningSocket() = default;
  ListeningSocket(ListeningSocket&&) = default;
  ListeningSocket& operator=(ListeningSocket&& other) noexcept {
    std::swap(descriptor, other.descriptor);
    admit.swap(other.admit);
    take_agreed.swap(other.take_agreed);
    unlink_path.swap(other.unlink_path);
    return *this;
  }
  ~ListeningSocket();

  /// Accepts all waiting peers. If one cannot be accepted for lack of room, descriptors or memory,
  /// the socket, which stays readable, is not watched for 200 ms, to avoid a busy loop.
  ///
  /// @param watch  of the socket, a Loop::Handle or Watch whose callback calls this.
  template <typename Handle>
  void accept_all(Handle& watch, const LogSink& log, const std::function<bool()>& has_room,
                  const std::function<Status(ConnectedSocket peer)>& let_in);

 private:
  /// The next connected peer; none (-1) if there is none. Errors: System.
  [[nodiscard]] Result<ConnectedSocket> accept(const LogSink& log) const;
};

/// A socket address of any family.
struct Address {
  Address(const void* data, unsigned length);
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }

  sockaddr_storage storage{};
  unsigned size;  ///< [byte]
};

/// A new non-blocking socket of the address's family. Errors: System.
Result<Descriptor> open_socket(const Address& address);

/// Whether a TCP connection is connected to itself. The kernel makes such a connection if no
/// process listens and the ephemeral port of this end equals the destination; treat it as refused.
bool is_with_itself(int socket);

/// How long to wait for a peer's answer if `wait` is 0.
constexpr std::chrono::seconds kAnswerTime{4};

/// Whether an address is of this host. If that cannot be tested, it is assumed to be.
bool is_of_this_host(Address address);
inline constexpr const char* kNotOfThisHost = "this host does not have the address yet; waiting";

/// A socket bound to an address that this host has now or gets later, and a listening one; `name`
/// is for error messages. Errors: System.
Result<Descriptor> bind_socket(const Address& address, const std::string& name);
Result<Descriptor> listen_on(const Address& address, const std::string& name);

/// How long a TCP peer may leave data unacknowledged: with the delay of timers, a vanished peer is
/// detected within 4 s.
constexpr std::chrono::milliseconds kVanishTime{3500};

/// Makes a TCP connection send small messages at once, and detect a vanished peer while it is idle:
/// keepalive probes after 1 and 2 s, closed after 3 s. No effect on sockets other than TCP.
void set_up_connection(int socket);
/// Makes a connection that only receives time out too (TCP_USER_TIMEOUT). On a sender, this would
/// also close the connection of a slow reader; see look_at_peer().
void set_up_reader(int socket);

/// What this host's kernel knows about the peer's kernel.
struct PeerLook {
  bool vanished = false;     ///< no answer for kVanishTime, though probed twice
  bool must_answer = false;  ///< data is unacknowledged: look again after `next`
  std::chrono::milliseconds next{0};
};

/// Checks whether a TCP peer to which data was sent is still there; always all false for sockets
/// other than TCP.
PeerLook look_at_peer(int socket);

/// Waits until the peer's kernel has acknowledged all data, has reset the connection or has
/// vanished, or until `longest` has passed.
void await_acknowledgement(int socket, std::chrono::milliseconds longest);

template <typename Handle>
void ListeningSocket::accept_all(Handle& watch, const LogSink& log,
                                 const std::function<bool()>& has_room,
                                 const std::function<Status(ConnectedSocket peer)>& let_in) {
  constexpr std::chrono::milliseconds kRetryTime{200};
  bool must_wait = !has_room();
  for (; !must_wait; must_wait = must_wait || !has_room()) {
    auto peer = accept(log);
    if (peer && !*peer) break;
    auto done = peer ? let_in(std::move(*peer)) : Status(peer.error());
    must_wait = !done;
    if (must_wait && !is_paused && log)
      log(Level::Warning,
          "not accepting connections: " + done.error().text() + "; retrying every 200 ms");
  }
  if (must_wait) watch.call_at(std::chrono::steady_clock::now() + kRetryTime);
  if (std::exchange(is_paused, must_wait) != must_wait)
    static_cast<void>(watch.want(must_wait ? 0U : EPOLLIN));
}

}  // namespace hc
