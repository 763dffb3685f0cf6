// SPDX-License-Identifier: Apache-2.0
#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <vector>

#include <hc/base/backoff.h>
#include <hc/link/stream/connection.h>
#include <hc/link/stream/ends.h>
#include <hc/mtp/codec.h>
#include <hc/os/loop.h>

namespace hc::internal {
namespace {

// Between messages that follow one another one looks for new peers only so often.
constexpr std::chrono::microseconds kFollowTime{10};
constexpr std::chrono::milliseconds kNewPeerPeriod{1};

/// A connection for each reader; see listening_sink().
class ListeningSink final : public Sink {
 public:
  ListeningSink(ListeningSocket socket, std::unique_ptr<Loop> loop, std::int64_t readers,
                bool stays, const Policy& policy, LinkOptions options)
      : socket_(std::move(socket)),
        loop_(std::move(loop)),
        readers_(readers),
        stays_(stays),
        policy_(policy),
        options_(std::move(options)),
        absence_(policy.timeout) {}

  Status begin() {
    auto watched = loop_->watch(socket_.descriptor.get(), EPOLLIN, [this](auto) { accept_all(); });
    if (!watched) return watched.error();
    listening_ = std::move(*watched);
    return {};
  }

  Status send(const Message& message) override {
    Outgoing outgoing(encoder_.encode(message), message);
    while (true) {
      if (begun_ && readers_ > 0 && !stays_ && peers_.empty())
        return Error{Code::Closed, "all readers disconnected"};
      if (peers_.empty() && !waits_for_peer()) {
        let_in();
        if (peers_.empty()) {
          ++traffic_.messages;
          ++(absence_.is_over() ? traffic_.timed_out : traffic_.cut);
          return {};
        }
        absence_.renew();
      }
      auto now = std::chrono::steady_clock::now();
      bool follows = now - last_send_ < kFollowTime && now - last_look_ < kNewPeerPeriod;
      if (!begun_ || peers_.empty() || !follows) {
        if (auto awaited = await_readers(); !awaited) return awaited;
        last_look_ = now = std::chrono::steady_clock::now();
      }
      begun_ = true;
      auto has = put_to_all(outgoing, now);
      if (has && !*has) has = has_reader();
      if (!has) return has.error();
      if (!*has) continue;  // the message is for the next who comes
      last_send_ = now;
      ++traffic_.messages;
      traffic_.bytes += outgoing.size();
      return {};
    }
  }

  Status close() override {
    Status awaited;
    if (readers_ > 0 && !begun_) awaited = await_readers();
    let_in();  // who has just come finds the end too
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

  std::optional<std::size_t> readers() override {
    let_in();
    for (std::size_t i = peers_.size(); i-- > 0;) {
      pollfd polled{peers_[i]->descriptor(), 0, 0};
      ::poll(&polled, 1, 0);
      if (peers_[i]->has_failed() || (polled.revents & (POLLERR | POLLHUP)) != 0) leave(i);
    }
    return peers_.size();
  }

 private:
  /// Makes peers of those who wait outside, as far as there is room.
  void accept_all() {
    auto has_room = [this] {
      for (std::size_t i = peers_.size(); i-- > 0 && peers_.size() >= kMaxPeers;)
        if (peers_[i]->has_failed()) leave(i);
      return peers_.size() < kMaxPeers;
    };
    socket_.accept_all(listening_, options_.log, has_room,
                       [this](ConnectedSocket accepted) -> Status {
                         auto connection = Connection::make(std::move(accepted), policy_, options_);
                         if (!connection) return connection.error();
                         peers_.push_back(std::move(*connection));
                         return {};
                       });
  }

  /// Another link may listen here from now on, while this object still exists.
  void stop_listening() {
    while (!peers_.empty()) leave(peers_.size() - 1);
    listening_.reset();
    socket_ = ListeningSocket();
  }

  void let_in() {
    if (socket_.is_paused) accept_all();  // there may be room by now
    static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
  }

  /// Whether a message without a reader waits for one.
  [[nodiscard]] bool waits_for_peer() const {
    if (readers_ == 0 || (begun_ && absence_.is_over())) return false;
    return !begun_ || !stays_ || policy_.writer_waits();
  }

  /// Waits for those that the next message is for, or for all before the first one. Who has left
  /// is awaited no longer than the policy says.
  Status await_readers() {
    const bool any = begun_ ? readers_ != 0 : readers_ < 0;
    const auto readers = any ? 1 : begun_ ? 0 : static_cast<std::size_t>(readers_);
    let_in();
    const bool awaits = peers_.size() < readers && options_.awaits_reader;
    if (awaits) options_.awaits_reader(true);
    Status outcome;
    for (; outcome && peers_.size() < readers; let_in()) {
      const auto now = std::chrono::steady_clock::now();
      if (begun_ && !absence_.waits(0, now)) {
        if (options_.log) options_.log(Severity::Warning, absence_.line());
        break;
      }
      auto come = wait_for(loop_->descriptor(), POLLIN, options_.stop, absence_.due());
      if (!come) outcome = come.error();
    }
    absence_.end();
    if (awaits) options_.awaits_reader(false);
    return outcome;
  }

  void leave(std::size_t peer) {
    // Its dropped bytes count where no other reader has got them.
    Traffic losses = peers_[peer]->losses();
    if (peers_.size() > 1) losses.bytes = 0;
    traffic_ += losses;
    peers_.erase(peers_.begin() + static_cast<std::ptrdiff_t>(peer));
    last_look_ = {};  // there is room for who waits outside
  }

  /// Whether some of what a peer is to get is in memory of ours still, so that it is no use to ask
  /// whether it has been taken.
  Result<bool> put_to_all(Outgoing& message, TimePoint now) {
    bool is_ours = false;
    for (std::size_t i = 0; i < peers_.size();) {
      auto sent = peers_[i]->send(message, now);
      if (!sent && (sent.error().code == Code::Stopped || sent.error().code == Code::Truncated))
        return sent.error();
      is_ours = is_ours || (sent && !*sent);
      if (sent)
        ++i;
      else
        leave(i);
    }
    return is_ours;
  }

  /// Whether a peer has taken what was sent to it, or will.
  ///
  /// A peer that has shut its own side may read on, as `nc -N` does, or have left. Over TCP a write
  /// succeeds in either case; what shows it is its kernel's answer, an acknowledgement or a reset.
  [[nodiscard]] Result<bool> has_taken(const Connection& peer) const {
    Backoff backoff(std::chrono::milliseconds(1), std::chrono::milliseconds(200));
    while (true) {
      pollfd polled{peer.descriptor(), POLLRDHUP, 0};
      ::poll(&polled, 1, 0);
      if ((polled.revents & (POLLERR | POLLHUP)) != 0) return false;
      bool shut = (polled.revents & POLLRDHUP) != 0;
      int unanswered = 0;
      if (!shut || !policy_.writer_waits() ||
          ::ioctl(peer.descriptor(), SIOCOUTQ, &unanswered) != 0 || unanswered == 0)
        return true;
      if (look_at_peer(peer.descriptor()).vanished) return false;
      auto waited =
          wait_for(-1, 0, options_.stop, std::chrono::steady_clock::now() + backoff.next());
      if (!waited) return waited.error();
    }
  }

  /// Whether there is a reader that has taken what was sent; one is enough.
  Result<bool> has_reader() {
    while (!peers_.empty()) {
      auto taken = has_taken(*peers_.back());
      if (!taken) return taken.error();
      if (*taken) return true;
      leave(peers_.size() - 1);
    }
    return false;
  }

  ListeningSocket socket_;
  std::unique_ptr<Loop> loop_;  // of the listening socket
  Loop::Handle listening_;
  std::int64_t readers_;  // to wait for before the first message and before the end; -1: one, none
  bool stays_;            // when all who were waited for have left
  Policy policy_;         // of each peer
  LinkOptions options_;
  Patience absence_;                 // with all peers that have left
  bool begun_ = false;               // the readers that were to be waited for have come
  TimePoint last_send_, last_look_;  // the latter: who wants to be let in
  Encoder encoder_;
  std::vector<std::unique_ptr<Connection>> peers_;
  Traffic traffic_;  // with the losses of those that have left
};

}  // namespace

Result<std::unique_ptr<Sink>> listening_sink(ListeningSocket socket, const Uri& uri,
                                             const LinkOptions& options) {
  auto readers = number_option(uri, "readers", -1, {0, kMaxPeers});
  if (!readers) return readers.error();
  auto stays = number_option(uri, "stay", 0, {0, 1});
  if (!stays) return stays.error();
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  auto loop = Loop::make();
  if (!loop) return loop.error();
  auto sink = std::make_unique<ListeningSink>(std::move(socket), std::move(*loop), *readers,
                                              *stays == 1, *policy, options);
  if (auto begun = sink->begin(); !begun) return begun.error();
  return std::unique_ptr<Sink>(std::move(sink));
}

}  // namespace hc::internal
