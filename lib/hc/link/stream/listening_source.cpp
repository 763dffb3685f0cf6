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
    auto watched = loop_->watch(socket_.descriptor.get(), EPOLLIN, [this](auto) { accept_all(); });
    if (!watched) return watched.error();
    listening_ = std::move(*watched);
    return {};
  }

  Result<Got> take(Message& message) override {
    constexpr int kTakesBetween = 64;  // before the others are asked, whatever the ready ones have
    message = {};
    if (ready_.empty() || ++takes_ > kTakesBetween) {
      takes_ = 0;
      if (auto asked = loop_->turn(std::chrono::milliseconds(0)); !asked) return asked.error();
    }
    while (!ready_.empty()) {
      if (turn_ >= ready_.size()) turn_ = 0;
      Peer& peer = *ready_[turn_];
      auto got = peer.source->take(message);
      if (!got || *got == Got::End) {
        const bool is_bad = !got && got.error().code != Code::Truncated &&
                            got.error().code != Code::Closed && got.error().code != Code::System;
        leave(peer, got ? "" : "closed a connection: " + in_words(got.error()), is_bad);
      } else if (*got == Got::Nothing) {
        peer.is_ready = false;
        std::erase(ready_, &peer);
        await_rest(peer);
      } else {
        peer.heard = ++count_;
        peer.header_due.reset();
        ++turn_;
        return Got::Message;
      }
    }
    return Got::Nothing;
  }

  [[nodiscard]] int descriptor() const override { return loop_->descriptor(); }
  [[nodiscard]] Traffic traffic() const override {
    Traffic all = left_;
    for (const auto& peer : peers_) all += peer->source->traffic();
    return all;
  }

 private:
  struct Peer {
    std::unique_ptr<StreamSource> source;
    std::uint64_t heard = 0;  // when: the number of messages and peers that had come by then
    bool is_ready = false;    // is in ready_
    TimePoint said_at;        // something of a message, last
    Loop::Handle watch, header_due;
  };

  /// A peer that begins a message must say its header in time; inside a message it may be silent
  /// for long only as long as nobody else waits for its place.
  void await_rest(Peer& peer) {
    peer.said_at = std::chrono::steady_clock::now();
    if (!peer.source->in_header()) return peer.header_due.reset();
    if (peer.header_due) return;
    peer.header_due = loop_->call_at(peer.said_at + times_.header, [this, each = &peer] {
      leave(*each, "closed a connection: no whole header in " +
                       std::to_string(times_.header.count()) + " s");
    });
  }

  /// Lets in who waits, as far as there is room or can be made.
  void accept_all() {
    auto is_full = [this] { return peers_.size() == kMaxPeers; };
    auto has_room = [&] { return !is_full() || find_idlest() != peers_.size(); };
    socket_.accept_all(listening_, options_.log, has_room, [&](ConnectedSocket accepted) -> Status {
      auto peer = std::make_unique<Peer>();
      auto watched = loop_->watch(accepted.get(), EPOLLIN, [this, each = peer.get()](auto) {
        if (std::exchange(each->is_ready, true)) return;
        ready_.push_back(each);
      });
      if (!watched) return watched.error();
      if (is_full())
        leave(*peers_[find_idlest()], "closed the peer that was silent longest, to let another in");
      set_up_reader(accepted.get());
      peer->source = std::make_unique<StreamSource>(std::move(accepted), options_);
      peer->watch = std::move(*watched);
      peer->heard = ++count_;
      peers_.push_back(std::move(peer));
      return {};
    });
  }

  /// The peer whose last message was longest ago, of those that say nothing now, or are silent for
  /// long inside a message; peers_.size() when there is none.
  [[nodiscard]] std::size_t find_idlest() const {
    std::size_t idlest = peers_.size();
    for (std::size_t i = 0; i < peers_.size(); ++i) {
      const auto& source = peers_[i]->source;
      int unread = 0;
      if (idlest < peers_.size() && peers_[i]->heard > peers_[idlest]->heard) continue;
      const bool is_inside = !source->between_messages();
      if (is_inside && std::chrono::steady_clock::now() - peers_[i]->said_at < times_.silence)
        continue;
      if (::ioctl(source->descriptor(), FIONREAD, &unread) != 0) continue;
      if (unread == 0) idlest = i;
    }
    return idlest;
  }

  void leave(const Peer& peer, std::string_view why, bool is_bad = false) {
    if (!why.empty() && options_.log) options_.log(Severity::Warning, why);
    left_ += peer.source->traffic();
    left_.bad += is_bad ? 1 : 0;
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
  int takes_ = 0;            // since the others were last asked
  std::uint64_t count_ = 0;  // of messages and peers that have come
  Traffic left_;             // of the peers that have left
};

}  // namespace

Result<std::unique_ptr<Source>> listening_source(ListeningSocket socket, const LinkOptions& options,
                                                 PeerTimes times) {
  auto loop = Loop::make();
  if (!loop) return loop.error();
  auto source =
      std::make_unique<ListeningSource>(std::move(socket), std::move(*loop), options, times);
  if (auto begun = source->begin(); !begun) return begun.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace hc::internal
