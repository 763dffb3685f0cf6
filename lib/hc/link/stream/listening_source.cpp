// SPDX-License-Identifier: Apache-2.0
#include <sys/ioctl.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <hc/link/stream/ends.h>
#include <hc/link/stream/source.h>
#include <hc/os/loop.h>

namespace hc::internal {
namespace {

/// Takes turns with those of its peers who have messages; see listening_source().
class ListeningSource final : public Source {
 public:
  ListeningSource(ListeningSocket socket, std::unique_ptr<Loop> loop, LinkOptions options,
                  PeerTimes times)
      : socket_(std::move(socket)),
        loop_(std::move(loop)),
        options_(std::move(options)),
        times_(times) {}

  Status begin() {
    listening_ =
        HC_TRY(loop_->watch(socket_.descriptor.get(), EPOLLIN, [this](auto) { accept_all(); }));
    return {};
  }

  Result<Got> take(Message& message) override {
    constexpr int kTakesBetween = 64;  // before the others are asked, whatever the ready ones have
    message = {};
    if (ready_.empty() || ++takes_ > kTakesBetween) {
      takes_ = 0;
      HC_TRY(loop_->turn(std::chrono::milliseconds(0)));
    }
    while (!ready_.empty()) {
      if (turn_ >= ready_.size()) turn_ = 0;
      Peer& peer = *ready_[turn_];
      auto got = peer.source->take(message);
      if (!got || *got == Got::End) {
        if (!got && is_bad(got.error())) ++left_.bad;
        leave(peer, got ? "" : "closed a connection: " + in_words(got.error()));
      } else if (*got == Got::Nothing) {
        peer.is_ready = false;
        std::erase(ready_, &peer);
        await_rest(peer);
      } else {
        peer.header_due.reset();
        ++turn_;
        return Got::Message;
      }
    }
    return Got::Nothing;
  }

  [[nodiscard]] int descriptor() const override { return loop_->descriptor(); }
  [[nodiscard]] std::optional<std::size_t> peers() const override { return peers_.size(); }
  [[nodiscard]] Traffic traffic() const override {
    Traffic all = left_;
    for (const auto& peer : peers_) all += peer->source->traffic();
    return all;
  }

 private:
  struct Peer {
    std::unique_ptr<StreamSource> source;
    bool is_ready = false;  // is in ready_
    TimePoint said_at;      // something, last
    Loop::Handle watch, header_due;
  };

  /// Gives a peer that has begun a message its time for the header.
  void await_rest(Peer& peer) {
    peer.said_at = std::chrono::steady_clock::now();
    if (!peer.source->in_header()) return peer.header_due.reset();
    if (peer.header_due) return;
    peer.header_due = loop_->call_at(peer.said_at + times_.header, [this, each = &peer] {
      // What this module had no time to read is not late.
      if (has_unread(*each)) return each->header_due.reset();
      leave(*each, "closed a connection: no whole header in " +
                       std::to_string(times_.header.count()) + " s");
    });
  }
  static bool has_unread(const Peer& peer) {
    int unread = 0;
    return ::ioctl(peer.source->descriptor(), FIONREAD, &unread) == 0 && unread > 0;
  }

  /// Lets in who waits, as far as there is room or can be made.
  void accept_all() {
    auto is_full = [this] { return peers_.size() == kMaxPeers; };
    auto has_room = [&] { return !is_full() || find_idlest() != peers_.size(); };
    socket_.accept_all(listening_, options_.log, has_room, [&](ConnectedSocket accepted) -> Status {
      auto peer = std::make_unique<Peer>();
      auto watched = HC_TRY(loop_->watch(accepted.get(), EPOLLIN, [this, each = peer.get()](auto) {
        if (std::exchange(each->is_ready, true)) return;
        ready_.push_back(each);
      }));
      if (is_full())
        leave(*peers_[find_idlest()], "closed the peer that was silent longest, to let another in");
      set_up_reader(accepted.get());
      peer->source = std::make_unique<StreamSource>(std::move(accepted), options_);
      peer->watch = std::move(watched);
      peer->said_at = std::chrono::steady_clock::now();
      peers_.push_back(std::move(peer));
      return {};
    });
  }

  /// The peer that is silent longest, of those that are so between messages, or for long inside
  /// one; peers_.size() when there is none.
  [[nodiscard]] std::size_t find_idlest() const {
    std::size_t idlest = peers_.size();
    const auto now = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      const Peer& peer = *peers_[i];
      if (idlest < peers_.size() && peer.said_at > peers_[idlest]->said_at) continue;
      if (!peer.source->between_messages() && now - peer.said_at < times_.silence) continue;
      if (!has_unread(peer)) idlest = i;
    }
    return idlest;
  }

  void leave(const Peer& peer, std::string_view why) {
    if (!why.empty() && options_.log) options_.log(Level::Warning, why);
    left_ += peer.source->traffic();
    std::erase(ready_, &peer);
    std::erase_if(peers_, [&](const auto& entry) { return entry.get() == &peer; });
  }

  ListeningSocket socket_;
  std::unique_ptr<Loop> loop_;  // of the listening socket and all peers
  Loop::Handle listening_;
  LinkOptions options_;
  PeerTimes times_;
  std::vector<std::unique_ptr<Peer>> peers_;
  std::vector<Peer*> ready_;  // those that may have messages; they take turns
  std::size_t turn_ = 0;
  int takes_ = 0;  // since the others were last asked
  Traffic left_;   // of the peers that have left
};

}  // namespace

Result<std::unique_ptr<Source>> listening_source(ListeningSocket socket, const LinkOptions& options,
                                                 PeerTimes times) {
  auto loop = HC_TRY(Loop::make());
  auto source =
      std::make_unique<ListeningSource>(std::move(socket), std::move(loop), options, times);
  HC_TRY(source->begin());
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace hc::internal
