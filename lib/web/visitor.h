// SPDX-License-Identifier: Apache-2.0
#pragma once
// The clients of the server, and the state that their connections share. Server thread only.

#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/os/aside.h>
#include <hc/os/loop.h>
#include <web/server.h>

namespace hc::web {

class Visitor;

/// Shared by all connections.
struct Shared {
  Site* site = nullptr;
  Loop* loop = nullptr;
  LogSink log;
  std::list<Visitor*> strangers;  // without a session, oldest first
  std::size_t known = 0;          // number of visitors with a session
  std::list<Aside> asides;        // running
  bool is_ending = false;         // takes no more requests
  std::size_t sockets = 0;        // WebSockets that are not closed yet
  std::function<void()> on_last;  // called when the last WebSocket has closed; may be empty

  /// Calls a function of a site and logs exceptions. @returns  false if it has thrown.
  template <typename Call>
  bool guard(const Call& call) const {
    try {
      call();
      return true;
    } catch (const std::exception& error) {
      log(Level::Error, std::string("server: ") + error.what());
      return false;
    }
  }

  /// As Server::aside().
  Status aside(Work work);
};

/// The other end of a connection.
struct Peer {
  std::string name;              ///< local user, IPv4 address, or IPv6 network
  bool is_another_user = false;  ///< another local user, except root
};

/// Counts a connection for its lifetime, as a stranger until it has shown a session.
class Visitor {
 public:
  Visitor(std::shared_ptr<Shared> shared, Peer peer);
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;
  ~Visitor();

  /// Call this when it has shown a session. @returns  false if there is no room for it.
  bool know();
  [[nodiscard]] Shared& shared() const { return *shared_; }
  [[nodiscard]] const Peer& peer() const { return peer_; }
  [[nodiscard]] Site& site() const { return *shared_->site; }

  /// Closes the oldest stranger of the peer that has most of them; false: there are none.
  static bool drop_one(Shared& shared);

  std::function<void()> close;  ///< closes its socket

 private:
  const std::shared_ptr<Shared> shared_;
  const Peer peer_;
  bool is_known_ = false;
};

}  // namespace hc::web
