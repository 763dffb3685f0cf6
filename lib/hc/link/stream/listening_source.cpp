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

/// Takes messages from its peers in turn; see listening_source().
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
    constexpr int kTakesBetween = 64;  // then it looks for events, even if messages are waiting
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
    TimePoint said_at;      // when it last sent something
    Loop::Handle watch, header_due;
  };

  /// Starts the time limit for a header, if a peer has sent a part of one.
  void await_rest(Peer& peer) {
    peer.said_at = std::chrono::steady_clock::now();
    if (!peer.source->in_header()) return peer.header_due.reset();
    if (peer.header_due) return;
    peer.header_due = loop_->call_at(peer.said_at + times_.header, [this, each = &peer] {
      // The rest may have arrived while this module was busy.
      if (has_unread(*each)) return each->header_due.reset();
      leave(*each, "closed a connection: no complete header in " +
                       std::to_string(times_.header.count()) + " s");
    });
  }
  static bool has_unread(const Peer& peer) {
    int unread = 0;
    return ::ioctl(peer.source->descriptor(), FIONREAD, &unread) == 0 && unread > 0;
  }

  /// Accepts waiting connections, if there is room or a silent peer to replace.
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
        leave(*peers_[find_idlest()],
              "closed the peer that was silent longest, to make room for a new one");
      set_up_reader(accepted.get());
      peer->source = std::make_unique<StreamSource>(std::move(accepted), options_);
      peer->watch = std::move(watched);
      peer->said_at = std::chrono::steady_clock::now();
      peers_.push_back(std::move(peer));
      return {};
    });
  }

  /// The peer that has been silent longest, between messages or for PeerTimes::silence inside one;
  /// peers_.size() if there is none.
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
  std::unique_ptr<Loop> loop_;  // watches the listening socket and all peers
  Loop::Handle listening_;
  LinkOptions options_;
  PeerTimes times_;
  std::vector<std::unique_ptr<Peer>> peers_;
  std::vector<Peer*> ready_;  // may have messages
  std::size_t turn_ = 0;      // the next of ready_
  int takes_ = 0;             // since the last look for events
  Traffic left_;              // of peers that have left
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
