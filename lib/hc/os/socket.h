// SPDX-License-Identifier: Apache-2.0
#pragma once
// Stream sockets, TCP and Unix alike: connected, listening, and their peers.

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

/// A socket that listens, and what is to be cleaned up when it stops.
struct ListeningSocket {
  Descriptor descriptor;
  /// Whether a peer that was accepted is wanted; an error says why not. May be empty.
  std::function<Status(int peer)> admit;
  /// Gives the peers in place of accept(), where they agree on a channel first: the next, none (-1)
  /// just now, or an error of accept(). May be empty; `descriptor` is readable when it is to be
  /// called.
  std::function<Result<ConnectedSocket>(const LogSink& log)> take_agreed;
  std::string unlink_path;  ///< removed at the end; empty: nothing
  bool is_paused = false;   ///< somebody waits who could not be let in

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

  /// Lets in all who wait. Where one cannot be, as there is no room, descriptor or memory, the
  /// socket, which stays readable, is left alone for 200 ms, so that this costs no time.
  ///
  /// @param watch  of the socket: Loop::Handle or Watch; it is to call this.
  template <typename Handle>
  void accept_all(Handle& watch, const LogSink& log, const std::function<bool()>& has_room,
                  const std::function<Status(ConnectedSocket peer)>& let_in);

 private:
  /// The next peer that has connected; none (-1) when there is none just now. Errors: System.
  [[nodiscard]] Result<ConnectedSocket> accept(const LogSink& log) const;
};

/// Where a peer may listen: a sockaddr of some family.
struct Address {
  Address(const void* data, unsigned length);
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }

  sockaddr_storage storage{};
  unsigned size;  ///< [byte]
};

/// A fresh socket for an address, whose calls do not wait. Errors: System.
Result<Descriptor> open_socket(const Address& address);

/// Whether a TCP connection is one with itself. The kernel makes such a one where nobody listens
/// and the port that it chose for this end happens to be the other's; it counts as refused.
bool is_with_itself(int socket);

/// How long a peer may take to answer where `wait` is 0.
constexpr std::chrono::seconds kAnswerTime{4};

/// A socket bound to an address, and a listening one; `name` is for error lines.
/// Errors: System.
Result<Descriptor> bind_socket(const Address& address, const std::string& name);
Result<Descriptor> listen_on(const Address& address, const std::string& name);

/// How long a TCP peer may leave what it must answer without an answer: so one that vanishes is
/// noticed within 4 s, with what timers are late by.
constexpr std::chrono::milliseconds kVanishTime{3500};

/// Has a TCP connection send what is small at once, and notice a peer that vanishes while nothing
/// is said: it is asked after 1 and 2 s, and given up after 3 s. Harmless where the socket is not
/// TCP.
void set_up_connection(int socket);
/// Has a connection that only receives end by time too (TCP_USER_TIMEOUT). One that sends would end
/// when a slow reader has no room for as long; see look_at_peer().
void set_up_reader(int socket);

/// What a socket's kernel knows of the peer's kernel.
struct PeerLook {
  bool vanished = false;     ///< has not answered for kVanishTime, though asked twice
  bool must_answer = false;  ///< has not acknowledged all yet, so that one is to look again
  std::chrono::milliseconds next{0};  ///< when
};

/// Looks whether a peer of TCP that is sent something is still there; where the socket is not TCP,
/// there is nothing to look after.
PeerLook look_at_peer(int socket);

/// Waits until the peer's kernel has acknowledged all that was written, has reset the connection or
/// has vanished.
/// @param longest  to wait
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
