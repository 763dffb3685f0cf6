// SPDX-License-Identifier: Apache-2.0
#pragma once
// Performs the TLS handshakes of a listening link. Internal.

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

/// Accepts connections and performs TLS handshakes on the reactor's thread, independent of the
/// link's thread. Peers that are refused or too slow are logged.
class Acceptor {
 public:
  /// Maximum number of handshakes in progress; a new one replaces the oldest.
  static constexpr std::size_t kMaxHandshakes = 256;
  /// Maximum number of accepted peers; further ones wait in the kernel's backlog.
  static constexpr std::size_t kMaxAccepted = 64;
  /// How long a handshake may take.
  static constexpr std::chrono::seconds kPatience{4};

  Acceptor(ListeningSocket socket, std::shared_ptr<const Context> context)
      : socket_(std::move(socket)), context_(std::move(context)) {}
  ~Acceptor() { watch_.end(); }
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// Starts; returns a descriptor that is readable when take() has work. Errors: System.
  Result<Descriptor> start();
  /// The next accepted peer; none (-1) if there is none. May be called on any thread.
  ConnectedSocket take(const LogSink& log);

 private:
  struct Handshake {
    ConnectedSocket socket;
    std::string name;  // "192.168.1.7:40312"
    Loop::Handle watch;
  };
  using Peer = std::list<Handshake>::iterator;

  void accept_all();
  Status begin_handshake(ConnectedSocket accepted);
  void continue_handshake(Peer peer, bool is_late);
  void say(std::string line);
  void raise() const { ::eventfd_write(event_, 1); }

  ListeningSocket socket_;
  std::shared_ptr<const Context> context_;
  std::unique_ptr<Loop> loop_;  // for the listening socket and the handshakes
  Loop::Handle listening_;
  std::list<Handshake> handshakes_;
  bool is_crowded_ = false;
  internal::Remarks remarks_;
  std::mutex mutex_;
  std::deque<ConnectedSocket> accepted_;  // guarded by mutex_
  int event_ = -1;
  Watch watch_;
};

/// Resolves `tls:HOST:PORT`, and listens at `tls-listen:[HOST:]PORT`.
/// Errors: Invalid, NotFound, System.
Result<internal::Peer> find_peer(const Uri& uri);
Result<ListeningSocket> listen(const Uri& uri, const LogSink& log);

}  // namespace hc::tls
