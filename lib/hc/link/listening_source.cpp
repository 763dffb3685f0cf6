// SPDX-License-Identifier: Apache-2.0
#include <hc/link/listening_source.h>

#include <sys/ioctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include <hc/link/dialer.h>
#include <hc/link/transports.h>
#include <hc/os/epoll.h>

namespace hc::internal {
namespace {

constexpr std::chrono::milliseconds kRetryTime{200};  // until one is let in who could not be

bool is_readable(int descriptor) {
  pollfd polled{descriptor, POLLIN, 0};
  return ::poll(&polled, 1, 0) > 0;
}

}  // namespace

Result<std::unique_ptr<Source>> ListeningSource::make(ListeningSocket socket,
                                                      const LinkOptions& options) {
  auto poll = make_epoll();
  if (!poll) return poll.error();
  auto timer = make_timer();
  if (!timer) return timer.error();
  std::unique_ptr<ListeningSource> source(
      new ListeningSource(std::move(socket), std::move(*poll), std::move(*timer), options));
  auto& self = *source;
  for (Descriptor* descriptor : {&self.socket_.descriptor, &self.timer_})
    if (auto watched = self.watch(descriptor->get(), descriptor); !watched) return watched.error();
  return std::unique_ptr<Source>(std::move(source));
}

Status ListeningSource::watch(int descriptor, void* who) {
  return control(poll_, EPOLL_CTL_ADD, descriptor, EPOLLIN, {.ptr = who});
}

void ListeningSource::forget(int descriptor) {
  static_cast<void>(control(poll_, EPOLL_CTL_DEL, descriptor));
}

/// Asks who has something; gives whether there was anything before the time was up.
///
/// Errors: Stopped, System.
Result<bool> ListeningSource::poll(std::chrono::milliseconds timeout) {
  takes_ = 0;
  std::array<epoll_event, 64> events;
  auto count = system_call("epoll_wait", "", [&] {
    return ::epoll_wait(poll_.get(), events.data(), static_cast<int>(events.size()),
                        static_cast<int>(timeout.count()));
  });
  if (!count) return count.error();
  bool has_come = false, is_to_stop = false;
  for (const auto& event : std::span(events).first(static_cast<std::size_t>(*count))) {
    void* who = event.data.ptr;
    if (who == &stop_) {
      is_to_stop = true;
    } else if (who == &socket_.descriptor || who == &timer_) {
      has_come = true;
    } else if (auto& peer = *static_cast<Peer*>(who); !peer.is_ready) {
      peer.is_ready = true;
      ready_.push_back(&peer);
    }
  }
  if (has_come) accept_all();
  if (is_to_stop && timeout.count() != 0) return Error{Code::Stopped, "asked to stop"};
  return *count > 0;
}

Result<bool> ListeningSource::wait(int stop, std::chrono::milliseconds timeout) {
  if (auto watched = watch_stop(stop); !watched) return watched.error();
  return poll(timeout);
}

Status ListeningSource::watch_stop(int stop) {
  if (stop == stop_) return {};
  if (stop_ >= 0) forget(stop_);
  stop_ = stop;
  return stop >= 0 ? watch(stop, &stop_) : Status();
}

/// Lets in who waits, as far as there is room.
void ListeningSource::accept_all() {
  while (true) {
    bool full = peers_.size() == kMaxPeers;
    if (full && !is_readable(socket_.descriptor.get())) return accept_later(false);
    std::size_t idlest = full ? find_idlest() : peers_.size();
    if (full && idlest == peers_.size()) return accept_later(true);
    auto accepted = accept_peer(socket_, options_.log);
    if (accepted && !*accepted) return accept_later(false);
    auto peer = std::make_unique<Peer>();
    auto watched = accepted ? watch(accepted->get(), peer.get()) : Status(accepted.error());
    if (!watched) {
      if (!later_ && options_.log)
        options_.log(Severity::Warning, "nobody is let in for now: " + in_words(watched.error()));
      return accept_later(true);
    }
    if (full) leave(*peers_[idlest], "closed the peer that was silent longest, to let another in");
    set_up_reader(accepted->get());
    peer->source = std::make_unique<StreamSource>(std::move(*accepted), options_);
    peer->heard = ++count_;
    peers_.push_back(std::move(peer));
  }
}

/// Says whether somebody waits who cannot be let in now: then the listening socket, which stays
/// readable, is overlooked, and a timer tells when to try again.
void ListeningSource::accept_later(bool later) {
  if (!later && !later_) return;
  set_timer(timer_, later ? kRetryTime : std::chrono::milliseconds(0));
  if (later)
    forget(socket_.descriptor.get());
  else
    static_cast<void>(watch(socket_.descriptor.get(), &socket_.descriptor));
  later_ = later;
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
  Traffic traffic = peer.source->traffic();
  left_.messages += traffic.messages;
  left_.bytes += traffic.bytes;
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
  for (const auto& peer : peers_) {
    all.messages += peer->source->traffic().messages;
    all.bytes += peer->source->traffic().bytes;
  }
  return all;
}

Result<Got> ListeningSource::take(Message& message) {
  constexpr int kTakesBetween = 64;  // before the others are asked, whatever the ready ones have
  message = {};
  if (ready_.empty() || ++takes_ > kTakesBetween)
    if (auto asked = poll(std::chrono::milliseconds(0)); !asked) return asked.error();
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
