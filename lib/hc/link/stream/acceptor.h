// SPDX-License-Identifier: Apache-2.0
#pragma once
// Lets peers in as they come, while the thread that will serve them does other things. Internal.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <hc/os/reactor.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// Accepts the peers of a listening socket, by the reactor or by who asks for them.
class Acceptor {
 public:
  /// Errors: System.
  static Result<std::unique_ptr<Acceptor>> make(ListeningSocket socket, std::size_t room);
  ~Acceptor() { watch_.reset(); }
  Acceptor(const Acceptor&) = delete;
  Acceptor& operator=(const Acceptor&) = delete;

  /// Those who have come, and whoever waits outside now.
  /// @param room  how many may be let in from now on.
  std::vector<Descriptor> take(std::size_t room);

  /// Whether somebody has come, or something is to be told; asked without a lock.
  [[nodiscard]] bool has_news() const { return has_news_.load(std::memory_order_relaxed); }
  /// Readable once somebody has come, until take().
  [[nodiscard]] int descriptor() const { return arrived_.get(); }
  /// What is to be told the log; empty afterwards.
  std::vector<std::string> take_remarks();

 private:
  Acceptor(ListeningSocket socket, Descriptor arrived, std::size_t room)
      : socket_(std::move(socket)), arrived_(std::move(arrived)), room_(room) {}

  void accept_all();

  std::mutex mutex_;
  ListeningSocket socket_;
  Descriptor arrived_;  // eventfd
  std::size_t room_;
  std::vector<Descriptor> newcomers_;
  std::vector<std::string> remarks_;
  std::atomic<bool> has_news_{false};
  Watch* watching_ = nullptr;  // for its callback, which may run while it is being destroyed
  std::unique_ptr<Watch> watch_;
};

}  // namespace hc::internal
