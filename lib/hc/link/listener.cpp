// SPDX-License-Identifier: Apache-2.0
#include <hc/link/listener.h>

#include <linux/sockios.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <array>

#include <hc/link/transports.h>

namespace hc::internal {
namespace {

constexpr long kRetryNanoseconds = 200'000'000;  // until one is let in again who could not be

bool is_readable(int descriptor) {
  pollfd polled{descriptor, POLLIN, 0};
  return ::poll(&polled, 1, 0) > 0;
}

/// Whether a peer has taken what was sent to it, or will.
///
/// A peer that has shut its own side may read on, as `nc -N` does, or have left. Over TCP a write
/// succeeds in either case; what tells is its kernel's answer, an acknowledgement or a reset.
Result<bool> has_taken(int peer, int stop) {
  Pauses pauses;
  while (true) {
    pollfd polled{peer, POLLRDHUP, 0};
    ::poll(&polled, 1, 0);
    if ((polled.revents & (POLLERR | POLLHUP)) != 0 || has_vanished(peer)) return false;
    bool shut = (polled.revents & POLLRDHUP) != 0;
    int under_way = 0;
    if (!shut || ::ioctl(peer, SIOCOUTQ, &under_way) != 0 || under_way == 0) return true;
    if (auto waited = pauses.next(stop); !waited) return waited.error();
  }
}

}  // namespace

Result<std::unique_ptr<Source>> ListeningSource::make(ListeningSocket socket,
                                                      const LinkOptions& options) {
  auto poll = system_call("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); });
  if (!poll) return poll.error();
  Descriptor poll_owner(*poll);
  auto timer = system_call("timerfd_create", "", [] {
    return ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  });
  if (!timer) return timer.error();
  std::unique_ptr<ListeningSource> source(
      new ListeningSource(std::move(socket), std::move(poll_owner), Descriptor(*timer), options));
  for (int descriptor : {source->socket_.descriptor.get(), source->timer_.get()})
    if (auto watched = source->watch(descriptor); !watched) return watched.error();
  return std::unique_ptr<Source>(std::move(source));
}

Status ListeningSource::watch(int descriptor) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = descriptor;
  auto added = system_call(
      "epoll_ctl", "", [&] { return ::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, descriptor, &event); });
  if (!added) return added.error();
  return {};
}

void ListeningSource::forget(int descriptor) {
  ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, descriptor, nullptr);
}

/// Lets in who waits, as far as there is room.
void ListeningSource::accept_all() {
  while (true) {
    bool full = peers_.size() == kMaxPeers;
    if (full && !is_readable(socket_.descriptor.get())) return accept_later(false);
    std::size_t idlest = full ? find_idlest() : peers_.size();
    if (full && idlest == peers_.size()) return accept_later(true);
    auto peer = accept_peer(socket_, options_);
    if (peer && !*peer) return accept_later(false);
    auto watched = peer ? watch(peer->get()) : Status(peer.error());
    if (!watched) {
      if (!later_ && options_.log) options_.log(Severity::Warning, watched.error().text());
      return accept_later(true);
    }
    if (full) leave(idlest, "closed the peer that was silent longest, to let another in");
    peers_.push_back({std::make_unique<StreamSource>(std::move(*peer), options_), ++count_});
  }
}

/// Says whether somebody waits who cannot be let in now: then the listening socket, which stays
/// readable, is overlooked, and a timer tells when to try again.
void ListeningSource::accept_later(bool later) {
  if (!later && !later_) return;
  itimerspec when{};
  if (later) when.it_value.tv_nsec = kRetryNanoseconds;
  ::timerfd_settime(timer_.get(), 0, &when, nullptr);
  if (later)
    forget(socket_.descriptor.get());
  else
    static_cast<void>(watch(socket_.descriptor.get()));
  later_ = later;
}

/// The peer whose last message was longest ago, of those that say nothing now; peers_.size() when
/// there is none.
std::size_t ListeningSource::find_idlest() const {
  std::size_t idlest = peers_.size();
  for (std::size_t i = 0; i < peers_.size(); ++i) {
    const auto& [source, heard] = peers_[i];
    int unread = 0;
    if (idlest < peers_.size() && heard > peers_[idlest].heard) continue;
    if (!source->between_messages() || ::ioctl(source->descriptor(), FIONREAD, &unread) != 0)
      continue;
    if (unread == 0) idlest = i;
  }
  return idlest;
}

void ListeningSource::leave(std::size_t peer, std::string_view why) {
  if (!why.empty() && options_.log) options_.log(Severity::Warning, why);
  Traffic traffic = peers_[peer].source->traffic();
  left_.messages += traffic.messages;
  left_.bytes += traffic.bytes;
  peers_.erase(peers_.begin() + static_cast<std::ptrdiff_t>(peer));
}

Traffic ListeningSource::traffic() const {
  Traffic all = left_;
  for (const auto& peer : peers_) {
    all.messages += peer.source->traffic().messages;
    all.bytes += peer.source->traffic().bytes;
  }
  return all;
}

Result<Got> ListeningSource::take(Message& message) {
  accept_all();
  for (std::size_t tried = 0; tried < peers_.size();) {
    turn_ %= peers_.size();
    auto got = peers_[turn_].source->take(message);
    if (!got || *got == Got::End) {
      leave(turn_, got ? "" : got.error().text());
    } else if (*got == Got::Message) {
      peers_[turn_++].heard = ++count_;
      return Got::Message;
    } else {
      ++turn_;
      ++tried;
    }
  }
  return Got::Nothing;
}

Result<std::unique_ptr<Sink>> make_listening_sink(ListeningSocket socket, const Uri& uri,
                                                  const LinkOptions& options) {
  auto readers = number_option(uri, "readers", 0);
  if (!readers) return readers.error();
  return std::unique_ptr<Sink>(new ListeningSink(std::move(socket), *readers, options));
}

/// Lets in who waits, as far as there is room; false when one cannot be let in now who is to be.
bool ListeningSink::accept_ready() {
  const std::size_t most = std::max(kMaxPeers, static_cast<std::size_t>(readers_));
  while (peers_.size() < most) {
    auto peer = accept_peer(socket_, options_);
    if (!peer && !later_ && options_.log) options_.log(Severity::Warning, peer.error().text());
    later_ = !peer;
    if (later_) return false;
    if (!*peer) return true;
    peers_.push_back(std::make_unique<StreamSink>(std::move(*peer), options_));
  }
  return true;
}

Status ListeningSink::await(std::size_t readers) {
  Pauses pauses;
  while (true) {
    bool all_are_in = accept_ready();
    if (peers_.size() >= readers) return {};
    if (!all_are_in) {  // the listening socket stays readable, so it cannot be waited for
      if (auto waited = pauses.next(options_.stop); !waited) return waited;
      continue;
    }
    std::array<int, 1> listening = {socket_.descriptor.get()};
    if (auto ready = wait_readable(listening, options_.stop); !ready) return ready.error();
  }
}

Status ListeningSink::send(const Message& message) {
  auto pieces = encoder_.encode(message);
  while (true) {
    if (begun_ && readers_ > 0 && peers_.empty())
      return Error{Code::Closed, "all readers have gone"};
    auto awaited = await(begun_ || readers_ == 0 ? 1 : static_cast<std::size_t>(readers_));
    if (!awaited) return awaited;
    begun_ = true;
    for (std::size_t i = 0; i < peers_.size();) {
      auto sent = peers_[i]->send_pieces(pieces);
      if (!sent && (sent.error().code == Code::Stopped || sent.error().code == Code::Truncated))
        return sent;
      if (sent)
        ++i;
      else
        peers_.erase(peers_.begin() + static_cast<std::ptrdiff_t>(i));  // it has left
    }
    // One reader that has it is enough; without any, the message is for the next who comes.
    while (!peers_.empty()) {
      auto taken = has_taken(peers_.back()->descriptor(), options_.stop);
      if (!taken) return taken.error();
      if (*taken) break;
      peers_.pop_back();
    }
    if (peers_.empty()) continue;
    ++traffic_.messages;
    for (auto piece : pieces) traffic_.bytes += piece.size();
    return {};
  }
}

Status ListeningSink::close() {
  Status awaited;
  if (readers_ > 0 && !begun_) awaited = await(static_cast<std::size_t>(readers_));
  for (auto& peer : peers_) static_cast<void>(peer->close());
  peers_.clear();
  socket_ = {};  // who has connected and was not accepted yet finds the end too
  return awaited;
}

}  // namespace hc::internal
