// SPDX-License-Identifier: Apache-2.0
#pragma once
// The listening end of tcp and unix links where messages come out: any number of peers come and go.
// Internal.

#include <memory>
#include <utility>
#include <vector>

#include <hc/link/stream/source.h>
#include <hc/os/loop.h>
#include <hc/os/socket.h>

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
  [[nodiscard]] int descriptor() const override { return loop_->descriptor(); }
  [[nodiscard]] Traffic traffic() const override;

 private:
  struct Peer {
    std::unique_ptr<StreamSource> source;
    std::uint64_t heard = 0;  // when: the number of messages and peers that had come by then
    bool is_ready = false;    // is in ready_
    Loop::Handle watch;
  };
  using Peers = std::vector<std::unique_ptr<Peer>>;

  ListeningSource(ListeningSocket socket, std::unique_ptr<Loop> loop, LinkOptions options)
      : socket_(std::move(socket)), loop_(std::move(loop)), options_(std::move(options)) {}

  void accept_all();
  [[nodiscard]] std::size_t find_idlest() const;
  void leave(const Peer& peer, std::string_view why);
  void rest(Peer& peer);

  ListeningSocket socket_;
  std::unique_ptr<Loop> loop_;  // of the listening socket and all peers
  Loop::Handle listening_;
  LinkOptions options_;
  Peers peers_;
  std::vector<Peer*> ready_;  // those that may have messages; they take turns
  std::size_t turn_ = 0;
  int takes_ = 0;            // since the others were last asked
  std::uint64_t count_ = 0;  // of messages and peers that have come
  Traffic left_;             // of the peers that have left
};

}  // namespace hc::internal
