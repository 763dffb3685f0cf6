// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shakes hands with those who connect to a TLS link's listening end. Internal.

#include <sys/eventfd.h>

#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include <hc/link/stream/dialer.h>
#include <hc/link/stream/remarks.h>
#include <hc/os/loop.h>
#include <hc/os/reactor.h>
#include <hc/os/socket.h>
#include <tls/context.h>

namespace hc::tls {

/// Accepts connections and agrees with their peers on TLS, in the reactor's thread: also while the
/// link's own thread does other things. Peers that are refused, or too slow, are logged.
class Acceptor {
 public:
  /// How many peers may be in a handshake; the oldest makes room for another.
  static constexpr std::size_t kMostHalfOpen = 256;
  /// How many may wait to be taken; others wait outside.
  static constexpr std::size_t kMostAgreed = 64;
  /// How long a handshake may take.
  static constexpr std::chrono::seconds kPatience{4};

  Acceptor(ListeningSocket socket, std::shared_ptr<const Context> context)
      : socket_(std::move(socket)), context_(std::move(context)) {}
  ~Acceptor() { watch_.end(); }
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// Begins; gives a descriptor that is readable when take() has something to do. Errors: System.
  Result<Descriptor> start();
  /// The next peer that has been agreed with; none (-1) when there is none. On any thread.
  ConnectedSocket take(const LogSink& log);

 private:
  struct HalfOpen {
    ConnectedSocket socket;
    std::string name;  // "192.168.1.7:40312"
    Loop::Handle watch;
  };
  using Peer = std::list<HalfOpen>::iterator;

  void accept_all();
  Status let_in(ConnectedSocket accepted);
  void go_on(Peer peer, bool is_late);
  void say(std::string line);
  void raise() const { ::eventfd_write(event_, 1); }

  ListeningSocket socket_;
  std::shared_ptr<const Context> context_;
  std::unique_ptr<Loop> loop_;  // of the listening socket and the half-open connections
  Loop::Handle listening_;
  std::list<HalfOpen> half_open_;
  bool is_crowded_ = false;
  internal::Remarks remarks_;
  std::mutex mutex_;
  std::deque<ConnectedSocket> agreed_;  // with the mutex
  int event_ = -1;
  Watch watch_;
};

/// The listener at `tls:HOST:PORT`, and a socket that listens at `tls-listen:[HOST:]PORT`.
/// Errors: Invalid, NotFound, System.
Result<internal::Peer> find_peer(const Uri& uri);
Result<ListeningSocket> listen(const Uri& uri);

}  // namespace hc::tls
