// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/dialer.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace hc::internal {

std::chrono::nanoseconds draw_pause(Backoff& backoff, std::minstd_rand& random) {
  return std::chrono::nanoseconds(
      std::uniform_int_distribution<std::int64_t>(0, backoff.next().count())(random));
}

Dialer::Dialer(Peer peer, std::chrono::seconds first, std::chrono::seconds patience, TimePoint now)
    : peer_(std::move(peer)),
      first_(first),
      patience_(patience),
      backoff_(kFirstPause, peer_.longest_pause),
      begin_(now),
      give_up_(now + first),
      next_try_(now) {}

Result<ConnectedSocket> Dialer::dial(TimePoint now) {
  if (!attempt_ && now >= next_try_) try_next(now);
  const bool has_connected = attempt_ && is_connected(now);
  if (!has_connected && attempt_ && now >= answer_due_) {
    fail(ETIMEDOUT, now);
    if (now < give_up_) try_next(now);
  }
  if (!has_connected && now >= give_up_)
    return Error{
        was_there_ ? Code::Closed : Code::NotFound,
        "no peer for " + std::to_string((was_there_ ? patience_ : first_).count()) + " s: " + why_};
  if (now >= log_due_) log_loss();
  if (has_connected) {
    was_there_ = true;
    connected_at_ = now;
    set_up_connection(attempt_.get());
    return std::move(attempt_);
  }
  if (!was_there_ && !why_.empty() && now >= begin_ + kQuiet && !std::exchange(is_awaited_, true)) {
    // The longest time that an option accepts is as good as for ever.
    log(Level::Warning, "no peer yet (" + why_ + "); " +
                            (first_ >= std::chrono::hours(24)
                                 ? "waiting"
                                 : "giving up after " + std::to_string(first_.count()) + " s"));
    news_ = "connected";
  }
  return ConnectedSocket();
}

void Dialer::in_use() {
  log_due_ = TimePoint::max();
  if (!news_.empty()) log(Level::Info, std::exchange(news_, {}));
}

void Dialer::log_loss() {
  log_due_ = TimePoint::max();
  log(Level::Warning, loss_ + "; reconnecting");
  news_ = "reconnected";
}

void Dialer::log(Level level, std::string_view line) const {
  if (log_) log_(level, line);
}

int Dialer::descriptor() const {
  return awaits_addresses() ? lookup_->descriptor() : attempt_.get();
}

TimePoint Dialer::due() const {
  auto next = attempt_ ? answer_due_ : next_try_;
  if (awaits_addresses()) next = is_awaited_ ? TimePoint::max() : begin_ + kQuiet;
  return std::min({give_up_, log_due_, next});
}

void Dialer::lost(TimePoint now, bool was_of_use, std::string why,
                  std::chrono::milliseconds log_after) {
  why_ = loss_ = std::move(why);
  log_due_ = now + log_after;
  if (log_due_ <= now) log_loss();
  give_up_ = now + patience_;
  if (was_of_use || now - connected_at_ >= kFirstPause) backoff_.reset();
  lookup_.reset();  // its result may be old
  next_try_ = was_of_use ? now : std::min(now + draw_pause(backoff_, random_), give_up_);
}

/// Begins to look up the name of the peer, or takes the result. Returns whether it has an address.
bool Dialer::has_addresses(TimePoint now) {
  if (!peer_.find) return true;
  std::optional<Found> found;
  if (lookup_) {
    found = lookup_->take();
    if (found) lookup_.reset();
  } else if (auto begun = Detached<Found>::begin(peer_.find)) {
    lookup_ = std::move(*begun);
    if (why_.empty()) why_ = peer_.name + ": no answer to its lookup";
  } else {
    found = begun.error();
  }
  if (found && *found) peer_.addresses = std::move(**found);
  if (found && peer_.addresses.empty()) {
    why_ = found->error().detail;
    const auto pause = std::min<std::chrono::nanoseconds>(draw_pause(backoff_, random_), kAway);
    next_try_ = std::max(std::min(now + pause, give_up_), now);
  }
  return !peer_.addresses.empty();
}

void Dialer::try_next(TimePoint now) {
  if (turn_ == 0 && !has_addresses(now)) return;
  const Address& address = peer_.addresses[turn_];
  auto socket = open_socket(address);
  if (!socket) return fail(errno, now);
  attempt_.descriptor = std::move(*socket);
  events_ = POLLOUT;
  const auto share = (give_up_ - now) / static_cast<std::int64_t>(peer_.addresses.size() - turn_);
  answer_due_ = now + std::min<std::chrono::nanoseconds>(kAnswer, share);
  if (::connect(attempt_.get(), address.get(), address.size) != 0 && errno != EINPROGRESS)
    fail(errno, now);
}

/// Whether the current attempt has succeeded. Ends it if it has failed.
bool Dialer::is_connected(TimePoint now) {
  if (attempt_.channel) return has_agreed(now);
  pollfd polled{attempt_.get(), POLLOUT, 0};
  if (::poll(&polled, 1, 0) <= 0) return false;
  int status = 0;
  socklen_t size = sizeof status;
  ::getsockopt(attempt_.get(), SOL_SOCKET, SO_ERROR, &status, &size);
  if (status == 0 && is_with_itself(attempt_.get())) status = ECONNREFUSED;
  auto admitted = status == 0 && peer_.admit ? peer_.admit(attempt_.get()) : Status();
  if (status == 0 && admitted) {
    if (!peer_.secure) return true;
    attempt_.channel = peer_.secure(attempt_.get());
    answer_due_ = now + kAnswerTime;
    return has_agreed(now);
  }
  fail(status == 0 ? EACCES : status, now);
  if (status == 0) why_ = admitted.error().detail;
  return false;
}

bool Dialer::has_agreed(TimePoint now) {
  auto awaited = attempt_.channel->agree();
  if (awaited) return (events_ = *awaited) == 0;
  fail(EACCES, now);
  why_ = awaited.error().detail;
  return false;
}

void Dialer::fail(int number, TimePoint now) {
  attempt_ = ConnectedSocket();
  why_ = std::strerror(number);
  turn_ = (turn_ + 1) % peer_.addresses.size();
  bool all_tried = turn_ == 0;
  was_silent_ = was_silent_ || number == ETIMEDOUT;
  if (all_tried) is_refused_ = !std::exchange(was_silent_, false);
  next_try_ = now;
  if (!all_tried || number == ETIMEDOUT) return;
  auto pause = draw_pause(backoff_, random_);
  bool away = number == ENETUNREACH || number == EHOSTUNREACH || number == ENETDOWN;
  next_try_ += away ? std::min<std::chrono::nanoseconds>(pause, kAway) : pause;
  next_try_ = std::max(std::min(next_try_, give_up_), now);  // one last attempt at the end
}

}  // namespace hc::internal
