// SPDX-License-Identifier: Apache-2.0
#pragma once
// The listening end of tcp and unix links where messages go in. Internal.

#include <memory>
#include <vector>

#include <hc/link/stream/connection.h>
#include <hc/mtp/codec.h>
#include <hc/os/loop.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// Puts each message to every peer that is connected, each by an Connection of its own: with
/// another policy than keep=all none waits for another.
///
/// Waits for the first readers; peers that leave are forgotten, and those that come later receive
/// what is sent from then on. When all have left, it waits for another; but if readers were counted
/// the link is closed, or stays: then only a policy that loses nothing waits for another. With a
/// count of 0 it never waits for a reader, and what is sent without one is lost.
class ListeningSink final : public Sink {
 public:
  /// A sink with the readers and the policy that the URI's options say. Errors: Invalid, System.
  static Result<std::unique_ptr<Sink>> make(ListeningSocket socket, const Uri& uri,
                                            const LinkOptions& options);

  Status send(const Message& message) override;
  Status close() override;
  void abandon() override;
  [[nodiscard]] Traffic traffic() const override;

 private:
  ListeningSink(ListeningSocket socket, std::unique_ptr<Loop> loop, std::int64_t readers,
                bool stays, const Policy& policy, LinkOptions options)
      : socket_(std::move(socket)),
        loop_(std::move(loop)),
        readers_(readers),
        stays_(stays),
        policy_(policy),
        options_(std::move(options)) {}

  void accept_all();
  void let_in();
  Status await_readers();
  void leave(std::size_t peer);
  Result<bool> put_to_all(Outgoing& message, TimePoint now);
  Result<bool> has_reader();
  [[nodiscard]] Result<bool> has_taken(const Connection& peer) const;

  ListeningSocket socket_;
  std::unique_ptr<Loop> loop_;  // of the listening socket
  Loop::Handle listening_;
  std::int64_t readers_;  // to wait for before the first message and before the end; -1: one, none
  bool stays_;            // when all who were waited for have left
  Policy policy_;         // of each peer
  LinkOptions options_;
  bool begun_ = false;               // the readers that were to be waited for have come
  TimePoint last_send_, last_look_;  // the latter: who wants to be let in
  Encoder encoder_;
  std::vector<std::unique_ptr<Connection>> peers_;
  Traffic traffic_;  // with the losses of those that have left
};

}  // namespace hc::internal
