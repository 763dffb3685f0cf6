// SPDX-License-Identifier: Apache-2.0
#pragma once
// Says messages to all who listen, and never waits for one of them. Internal to graph.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hc/mtp/message.h>
#include <hc/os/loop.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// The listening end of a Unix socket where messages go in. Unlike a listening sink it is used on
/// the thread of a loop, does not mind if nobody has come, and has something to say to who comes.
/// Who is more than kMostWaiting behind misses messages, whole ones. When more than kMostPeers have
/// come, the one that has read least has to leave: those who come are served.
class Announcer {
 public:
  static constexpr std::size_t kMostWaiting = std::size_t{4} << 20;  ///< [byte]
  static constexpr std::size_t kMostPeers = 64;                      ///< at once

  /// @param uri  `unix-listen:…`
  /// @param welcome  gives what is said first to each who comes; may be empty.
  ///
  /// Errors: Invalid, System (the name is in use).
  static Result<std::unique_ptr<Announcer>> make(
      Loop& loop, const std::string& uri, std::function<std::vector<Message>()> welcome = {});

  /// Says it to all there are; whether all have it or will.
  bool say(const Message& message);
  [[nodiscard]] bool is_heard() const { return !peers_.empty(); }
  /// Ends all connections there are.
  void leave_all() { peers_.clear(); }

 private:
  struct Peer {
    Descriptor socket;
    std::string waiting;  // bytes that the socket has not taken
    Loop::Handle watch;
    bool has_left = false;
  };

  Announcer(Loop& loop, ListeningSocket socket, std::function<std::vector<Message>()> welcome)
      : loop_(loop), socket_(std::move(socket)), welcome_(std::move(welcome)) {}

  void let_in();
  void leave_idlest();
  bool put(Peer& peer, const std::string& bytes);
  void write(Peer& peer);
  void serve(Peer& peer, std::uint32_t events);
  void forget_those_who_left();

  Loop& loop_;
  ListeningSocket socket_;
  std::function<std::vector<Message>()> welcome_;
  std::vector<std::unique_ptr<Peer>> peers_;
  Loop::Handle watch_;
};

/// Says one message to who listens at `unix:…`, if it can be said at once.
///
/// Errors: Invalid (another URI), Closed (nobody listens), System.
Status say_at_once(const std::string& uri, const Message& message);

}  // namespace hc::internal
