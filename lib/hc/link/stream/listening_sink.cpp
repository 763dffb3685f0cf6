// SPDX-License-Identifier: Apache-2.0
#include <linux/sockios.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <vector>

#include <hc/base/backoff.h>
#include <hc/link/audience.h>
#include <hc/link/stream/connection.h>
#include <hc/link/stream/ends.h>
#include <hc/mtp/codec.h>
#include <hc/os/loop.h>

namespace hc::internal {
namespace {

// How often a sink that sends looks for peers that have connected or left.
constexpr std::chrono::milliseconds kLookPeriod{1};

/// A connection for each reader; see listening_sink().
class ListeningSink final : public Sink {
 public:
  ListeningSink(ListeningSocket socket, std::unique_ptr<Loop> loop, Audience audience,
                const Policy& policy, LinkOptions options)
      : socket_(std::move(socket)),
        loop_(std::move(loop)),
        audience_(std::move(audience)),
        policy_(policy),
        options_(std::move(options)) {}

  Status begin() {
    listening_ =
        HC_TRY(loop_->watch(socket_.descriptor.get(), EPOLLIN, [this](auto) { accept_all(); }));
    return {};
  }

  Status send(const Message& message) override {
    Outgoing outgoing(encoder_.encode(message), message);
    while (true) {
      auto fate = audience_.decide(peers_.size());
      if (fate == Audience::Fate::End) return Error{Code::Closed, "all readers disconnected"};
      const auto now = std::chrono::steady_clock::now();
      const bool looks = fate != Audience::Fate::Sent || now - last_look_ >= kLookPeriod;
      if (looks) {
        let_in();
        last_look_ = now;
        fate = audience_.decide(peers_.size());
      }
      if (fate == Audience::Fate::Lost) {
        audience_.count_lost(traffic_);
        return {};
      }
      if (fate == Audience::Fate::Kept) {
        HC_TRY(await_readers());
        continue;
      }
      const bool is_pending = HC_TRY(put_to_all(outgoing, now));
      const bool is_unsure = !is_pending && (looks || peers_.empty());
      if (is_unsure && !HC_TRY(has_reader())) continue;  // the next reader gets the message
      ++traffic_.messages;
      traffic_.bytes += outgoing.size();
      return {};
    }
  }

  Status close() override {
    Status awaited;
    if (audience_.is_awaited()) awaited = await_readers();
    let_in();  // so that new peers see the end, too
    bool patient = true;
    for (auto& peer : peers_) {
      auto closed = peer->close(patient);
      patient = patient && (closed || closed.error().code == Code::Closed);
      if (awaited && !patient) awaited = closed;
    }
    stop_listening();
    return awaited;
  }

  void abandon() override {
    for (auto& peer : peers_) peer->abandon();
    stop_listening();
  }

  [[nodiscard]] Traffic traffic() const override {
    Traffic all = traffic_;
    std::uint64_t fewest_dropped = peers_.empty() ? 0 : all.bytes;
    for (const auto& peer : peers_) {
      Traffic losses = peer->losses();
      fewest_dropped = std::min(fewest_dropped, 0 - std::exchange(losses.bytes, 0));
      all += losses;
    }
    all.bytes -= fewest_dropped;
    return all;
  }

  [[nodiscard]] bool is_behind() const override {
    return std::ranges::any_of(peers_, [](const auto& peer) { return peer->is_behind(); });
  }

  std::optional<std::size_t> peers() override {
    let_in();
    for (std::size_t i = peers_.size(); i-- > 0;) {
      pollfd polled{peers_[i]->descriptor(), 0, 0};
      ::poll(&polled, 1, 0);
      if (peers_[i]->has_failed() || (polled.revents & (POLLERR | POLLHUP)) != 0) leave(i);
    }
    return peers_.size();
  }

 private:
  /// Accepts waiting connections, up to kMaxPeers.
  void accept_all() {
    auto has_room = [this] {
      for (std::size_t i = peers_.size(); i-- > 0 && peers_.size() >= kMaxPeers;)
        if (peers_[i]->has_failed()) leave(i);
      return peers_.size() < kMaxPeers;
    };
    socket_.accept_all(
        listening_, options_.log, has_room, [this](ConnectedSocket accepted) -> Status {
          auto connection = HC_TRY(Connection::make(std::move(accepted), policy_, options_));
          peers_.push_back(std::move(connection));
          return {};
        });
  }

  /// Frees the address for another link while this object still exists.
  void stop_listening() {
    while (!peers_.empty()) leave(peers_.size() - 1);
    listening_.reset();
    socket_ = ListeningSocket();
  }

  void let_in() {
    if (socket_.is_paused) accept_all();  // a peer may have left
    static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
  }

  Status await_readers() {
    return audience_.await(loop_->descriptor(), options_, [this]() -> Result<std::size_t> {
      let_in();
      return peers_.size();
    });
  }

  void leave(std::size_t peer) {
    // Dropped bytes do not count if another reader got them.
    Traffic losses = peers_[peer]->losses();
    if (peers_.size() > 1) losses.bytes = 0;
    traffic_ += losses;
    peers_.erase(peers_.begin() + static_cast<std::ptrdiff_t>(peer));
    last_look_ = {};  // a waiting peer may have its place
  }

  /// Sends a message to all peers. Returns whether a part of it is still to be written.
  Result<bool> put_to_all(Outgoing& message, TimePoint now) {
    bool is_pending = false;
    for (std::size_t i = 0; i < peers_.size();) {
      auto sent = peers_[i]->send(message, now);
      if (!sent && (sent.error().code == Code::Stopped || sent.error().code == Code::Truncated))
        return sent.error();
      is_pending = is_pending || (sent && !*sent);
      if (sent)
        ++i;
      else
        leave(i);
    }
    return is_pending;
  }

  /// Whether a peer has received the last message, or will.
  ///
  /// A peer that has shut down its direction may still read, as `nc -N` does, or have left. Over
  /// TCP a write succeeds in both cases; its kernel then answers: acknowledgement or reset.
  [[nodiscard]] Result<bool> has_taken(const Connection& peer) const {
    Backoff backoff(std::chrono::milliseconds(1), std::chrono::milliseconds(200));
    while (true) {
      pollfd polled{peer.descriptor(), POLLRDHUP, 0};
      ::poll(&polled, 1, 0);
      if (polled.revents != POLLRDHUP) return polled.revents == 0;
      int unanswered = 0;
      if (!policy_.writer_waits() || ::ioctl(peer.descriptor(), SIOCOUTQ, &unanswered) != 0 ||
          unanswered == 0)
        return true;
      if (look_at_peer(peer.descriptor()).vanished) return false;
      HC_TRY(wait_for(-1, 0, options_.stop, std::chrono::steady_clock::now() + backoff.next()));
    }
  }

  /// Whether at least one reader has received the last message. Removes those that have left.
  Result<bool> has_reader() {
    for (; !peers_.empty(); leave(peers_.size() - 1))
      if (HC_TRY(has_taken(*peers_.back()))) return true;
    return false;
  }

  ListeningSocket socket_;
  std::unique_ptr<Loop> loop_;  // watches the listening socket
  Loop::Handle listening_;
  Audience audience_;
  Policy policy_;  // for each peer
  LinkOptions options_;
  TimePoint last_look_;  // for peers that have connected or left
  Encoder encoder_;
  std::vector<std::unique_ptr<Connection>> peers_;
  Traffic traffic_;  // including losses of peers that have left
};

}  // namespace

Result<std::unique_ptr<Sink>> listening_sink(ListeningSocket socket, const Uri& uri,
                                             const LinkOptions& options) {
  auto policy = HC_TRY(parse_policy(uri));
  auto audience = HC_TRY(Audience::make(uri, kMaxPeers, policy, options));
  auto loop = HC_TRY(Loop::make());
  auto sink = std::make_unique<ListeningSink>(std::move(socket), std::move(loop),
                                              std::move(audience), policy, options);
  HC_TRY(sink->begin());
  return std::unique_ptr<Sink>(std::move(sink));
}

}  // namespace hc::internal
