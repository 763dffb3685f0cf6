// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/listening_source.h>

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>

#include <hc/link/stream/dialer.h>
#include <hc/link/transports.h>

namespace hc::internal {
Result<std::unique_ptr<Source>> ListeningSource::make(ListeningSocket socket,
                                                      const LinkOptions& options) {
  auto loop = Loop::make();
  if (!loop) return loop.error();
  std::unique_ptr<ListeningSource> source(
      new ListeningSource(std::move(socket), std::move(*loop), options));
  auto watched = source->loop_->watch(source->socket_.descriptor.get(), EPOLLIN,
                                      [self = source.get()](auto) { self->accept_all(); });
  if (!watched) return watched.error();
  source->listening_ = std::move(*watched);
  return std::unique_ptr<Source>(std::move(source));
}

/// Lets in who waits, as far as there is room or can be made.
void ListeningSource::accept_all() {
  auto is_full = [this] { return peers_.size() == kMaxPeers; };
  auto has_room = [&] { return !is_full() || find_idlest() != peers_.size(); };
  socket_.accept_all(listening_, options_.log, has_room, [&](Descriptor accepted) -> Status {
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

/// The peer whose last message was longest ago, of those that say nothing now; peers_.size() when
/// there is none.
std::size_t ListeningSource::find_idlest() const {
  std::size_t idlest = peers_.size();
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    const auto& source = peers_[i]->source;
    int unread = 0;
    if (idlest < peers_.size() && peers_[i]->heard > peers_[idlest]->heard) continue;
    if (!source->between_messages() || ::ioctl(source->descriptor(), FIONREAD, &unread) != 0)
      continue;
    if (unread == 0) idlest = i;
  }
  return idlest;
}

void ListeningSource::leave(const Peer& peer, std::string_view why) {
  if (!why.empty() && options_.log) options_.log(Severity::Warning, why);
  left_ += peer.source->traffic();
  std::erase(ready_, &peer);
  std::erase_if(peers_, [&](const auto& entry) { return entry.get() == &peer; });
}

/// Says that a peer has nothing more for now.
void ListeningSource::rest(Peer& peer) {
  peer.is_ready = false;
  std::erase(ready_, &peer);
}

Traffic ListeningSource::traffic() const {
  Traffic all = left_;
  for (const auto& peer : peers_) all += peer->source->traffic();
  return all;
}

Result<Got> ListeningSource::take(Message& message) {
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
      leave(peer, got ? "" : "closed a connection: " + in_words(got.error()));
    } else if (*got == Got::Nothing) {
      rest(peer);
    } else {
      peer.heard = ++count_;
      ++turn_;
      return Got::Message;
    }
  }
  return Got::Nothing;
}

}  // namespace hc::internal
