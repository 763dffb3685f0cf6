// SPDX-License-Identifier: Apache-2.0
#pragma once
// Broadcasts messages to all connected peers without blocking. Internal to graph.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hc/mtp/message.h>
#include <hc/os/loop.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// The writer's end of links over a Unix socket, used on the thread of a loop. Unlike a listening
/// sink it never blocks, and greets each new peer with `welcome`. A peer with kMaxQueued bytes
/// unread loses whole messages. Above kMaxPeers, the peer with most unread is disconnected in
/// favour of the new one.
class Announcer {
 public:
  static constexpr std::size_t kMaxQueued = std::size_t{4} << 20;  ///< for each peer [byte]
  static constexpr std::size_t kMaxPeers = 64;

  /// @param uri  `unix-listen:…`
  /// @param welcome  returns the first messages for a new peer; may be empty.
  ///
  /// Errors: Invalid, System (the name is in use).
  static Result<std::unique_ptr<Announcer>> make(
      Loop& loop, const std::string& uri, std::function<std::vector<Message>()> welcome = {});

  /// Sends a message to all peers; returns false if a peer has lost it.
  bool send(const Message& message);
  [[nodiscard]] bool has_peers() const { return !peers_.empty(); }
  void disconnect_all() { peers_.clear(); }

 private:
  struct Peer {
    Descriptor socket;
    std::string queued;  // bytes that the socket has not taken
    Loop::Handle watch;
    bool is_closed = false;
  };

  Announcer(Loop& loop, ListeningSocket socket, std::function<std::vector<Message>()> welcome)
      : loop_(loop), socket_(std::move(socket)), welcome_(std::move(welcome)) {}

  void accept();
  void disconnect_slowest();
  bool enqueue(Peer& peer, const std::string& bytes);
  void write(Peer& peer);
  void serve(Peer& peer, std::uint32_t events);
  void remove_closed();

  Loop& loop_;
  ListeningSocket socket_;
  std::function<std::vector<Message>()> welcome_;
  std::vector<std::unique_ptr<Peer>> peers_;
  Loop::Handle watch_;
};

/// Sends one message to the listener at `unix:…` without blocking.
///
/// Errors: Invalid (another scheme), Closed (no listener), System.
Status send_at_once(const std::string& uri, const Message& message);

}  // namespace hc::internal
