// SPDX-License-Identifier: Apache-2.0
#pragma once
// The listening ends of tcp and unix links: any number of peers come and go. Internal.

#include <memory>
#include <utility>
#include <vector>

#include <hc/link/socket.h>
#include <hc/link/stream_link.h>

namespace hc::internal {

/// How many peers a listening end has at once.
constexpr std::size_t kMaxPeers = 256;

/// Takes messages from all peers that connect, in the order in which they come. A peer that breaks
/// a rule is closed and the log told; the others notice nothing. Never ends by itself.
///
/// When there are kMaxPeers, the one whose last message was longest ago makes room for who comes,
/// unless it is inside a message: so peers that say nothing cannot keep others out.
class ListeningSource final : public Source {
 public:
  static Result<std::unique_ptr<Source>> make(ListeningSocket socket, const LinkOptions& options);

  Result<Got> take(Message& message) override;
  [[nodiscard]] int descriptor() const override { return poll_.get(); }
  [[nodiscard]] Traffic traffic() const override;

 private:
  struct Peer {
    std::unique_ptr<StreamSource> source;
    std::uint64_t heard = 0;  // when: the number of messages and peers that had come by then
  };

  ListeningSource(ListeningSocket socket, Descriptor poll, Descriptor timer, LinkOptions options)
      : socket_(std::move(socket)),
        poll_(std::move(poll)),
        timer_(std::move(timer)),
        options_(std::move(options)) {}

  Status watch(int descriptor);
  void forget(int descriptor);
  void accept_all();
  Status accept_one();
  void accept_later(bool later);
  [[nodiscard]] std::size_t find_idlest() const;
  void leave(std::size_t peer, std::string_view why);

  ListeningSocket socket_;
  Descriptor poll_;   // an epoll instance of the listening socket, the timer and all peers
  Descriptor timer_;  // says when to try again, while later_
  LinkOptions options_;
  std::vector<Peer> peers_;
  std::uint64_t count_ = 0;  // of messages and peers that have come
  bool later_ = false;       // somebody waits who could not be let in
  Traffic left_;             // of the peers that have left
  std::size_t turn_ = 0;     // whose messages come next, so that a busy peer cannot starve another
};

/// Puts each message to every peer that is connected. Waits for the first ones to come; peers that
/// leave are forgotten, and those that come later hear what is sent from then on. When all have
/// left, it waits for another, unless the readers were counted: then the link is closed.
class ListeningSink final : public Sink {
 public:
  /// @param readers  how many peers to wait for before the first message and before the end; 0: one
  ///     before the first message, none before the end.
  ListeningSink(ListeningSocket socket, std::int64_t readers, LinkOptions options)
      : socket_(std::move(socket)), readers_(readers), options_(std::move(options)) {}

  Status send(const Message& message) override;
  Status close() override;
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  bool accept_ready();
  Status await(std::size_t readers);

  ListeningSocket socket_;
  std::int64_t readers_;
  bool begun_ = false;  // the readers that were to be waited for have come
  bool later_ = false;  // somebody waits who could not be let in
  LinkOptions options_;
  Encoder encoder_;
  Traffic traffic_;
  std::vector<std::unique_ptr<StreamSink>> peers_;
};

/// A ListeningSink with the readers that the URI's option says. Errors: Usage.
Result<std::unique_ptr<Sink>> make_listening_sink(ListeningSocket socket, const Uri& uri,
                                                  const LinkOptions& options);

}  // namespace hc::internal
