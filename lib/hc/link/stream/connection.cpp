// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/connection.h>

#include <netinet/in.h>
#include <netinet/tcp.h>

#include <algorithm>

#include <hc/link/stream/ends.h>
#include <hc/os/socket.h>

namespace hc::internal {
namespace {

TimePoint clock_now() {
  return std::chrono::steady_clock::now();
}

bool is_tcp(int descriptor) {
  tcp_info info{};
  socklen_t size = sizeof info;
  return ::getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &size) == 0;
}

/// Limits what waits in the kernel to be sent to about 1/40 s, or messages would grow old there
/// where the network is slower than the bandwidth.
void keep_short(int descriptor, std::uint64_t bandwidth) {
  const int most = static_cast<int>(std::clamp<std::uint64_t>(bandwidth / 40, 4096, 1 << 20));
  ::setsockopt(descriptor, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most, sizeof most);
}

}  // namespace

Result<std::unique_ptr<Connection>> Connection::make(ConnectedSocket connection,
                                                     const Policy& policy,
                                                     const LinkOptions& options,
                                                     std::unique_ptr<Dialer> dialer) {
  std::unique_ptr<Connection> made(new Connection(policy, options, std::move(dialer)));
  HC_TRY(made->watch_.start(-1, [self = made.get()](auto events) { self->on_event(events); }));
  std::lock_guard lock(made->mutex_);
  auto now = clock_now();
  if (connection)
    made->connect(std::move(connection), now);
  else
    made->dial(now);
  made->arm(now);
  return made;
}

void Connection::connect(ConnectedSocket connection, TimePoint now) {
  is_tcp_ = is_tcp(connection.get());
  if (is_tcp_ && bandwidth_ > 0) keep_short(connection.get(), bandwidth_);
  writer_.start(std::move(connection));
  blocked_ = false;
  connected_at_ = now;
  look_due_ = TimePoint::max();
  watch_.move_to(writer_.descriptor());
}

void Connection::dial(TimePoint now) {
  stop_watching();  // before the dialer closes its descriptor
  auto made = dialer_->dial(now);
  if (!made) return fail(made.error());
  if (!*made) return watch_.move_to(dialer_->descriptor());
  dialer_->in_use();
  connect(std::move(*made), now);
}

void Connection::stop_watching() {
  watch_.move_to(-1);
  wanted_ = 0;
}

Status Connection::send(const Message& message) {
  Outgoing outgoing(encoder_.encode(message), message);
  auto sent = send(outgoing, clock_now());
  remarks_.flush(log_);
  if (!sent) return sent.error();
  ++messages_;
  bytes_ += outgoing.size();
  return {};
}

Result<bool> Connection::send(Outgoing& message, TimePoint now) {
  std::unique_lock lock(mutex_);
  if (failed_) return *failed_;
  is_sending_ = true;
  auto sent = hand_over(lock, message, now);
  is_sending_ = false;
  return sent;
}

Result<bool> Connection::hand_over(std::unique_lock<std::mutex>& lock, Outgoing& message,
                                   TimePoint now) {
  if (patience_.is_over()) {
    advance(now);
    if (failed_) return *failed_;
    if (drops_for_reader(message, now)) return false;
  }
  if (connected() && !blocked_ && queue_.pass(now, message.size())) {
    put(message.borrowed(), now);
  } else {
    queue_.push(writer_waits_ ? message.borrowed() : message.kept(), message.size(), losses_);
    if (!writer_waits_) advance(now);
  }
  if (failed_) return *failed_;
  bool is_pending = blocked_ || !queue_.empty() || !connected();
  if (writer_waits_ && is_pending) {
    auto drained = drain(lock, &message);
    patience_.end();
    if (!drained) return drained.error();
    return !patience_.is_over();
  }
  if (writer_.borrows()) writer_.keep(message.kept());
  if (is_pending) arm(now);
  return all_written();
}

/// Collects a message or writes it at once; nothing is queued before it.
void Connection::put(const Parcel& parcel, TimePoint now) {
  const bool is_first = writer_.gathered() == 0;
  if (writer_.add(parcel)) {
    if (is_first) oldest_ = now;
    bool pays = !is_first || gathering_.pays(now - last_write_ < kFollowTime);
    if (pays && writer_.gathered() < kFlushBytes && now - oldest_ < kFlushAge) {
      is_gathering_ = true;
      // The reactor writes the batch only if no further message is sent.
      if (!std::exchange(flush_is_due_, true)) watch_.call_at(flush_due());
      return;
    }
  }
  write();
}

void Connection::write() {
  if (std::exchange(is_gathering_, false)) gathering_.learn(writer_.messages());
  auto written = writer_.write();
  last_write_ = clock_now();
  if (!written) return lose_connection(written.error(), last_write_);
  blocked_ = !*written;
  if (!is_tcp_ || look_due_ != TimePoint::max()) return;
  look_due_ = last_write_ + kLookPeriod;
  watch_.call_at(look_due_);
}

/// Does everything that is due and possible without waiting.
void Connection::advance(TimePoint now) {
  if (failed_) return;
  if (look_due_ <= now) look_at_reader(now);
  if (!failed_ && !connected()) dial(now);
  while (!failed_ && connected()) {
    if (!writer_.empty()) write();
    if (blocked_ || !writer_.empty()) return;
    while (queue_.ready_at(now, losses_) <= now) {
      if (!writer_.empty() && !writer_.has_room(queue_.front().size())) break;
      writer_.add(queue_.pop(now));
    }
    if (writer_.empty()) return;
  }
}

void Connection::lose_connection(const Error& why, TimePoint now) {
  stop_watching();
  look_due_ = TimePoint::max();
  blocked_ = false;
  if (dialer_ == nullptr) return fail(why);
  writer_.start(ConnectedSocket());
  dialer_->lost(now, now - connected_at_ >= Dialer::kUseTime, in_words(why));
}

void Connection::fail(const Error& why) {
  failed_ = why;
  stop_watching();
  if (!writer_waits_) {
    losses_.dropped_disconnect += queue_.clear(losses_) + writer_.clear();
    return;
  }
  // The last message, in the queue or the writer, is the one being sent. Its caller gets the error,
  // so it does not count as lost.
  Traffic reported;
  const bool is_queued = queue_.clear(reported) > 0;
  auto begun = writer_.clear();
  if (is_sending_ && !is_queued && begun > 0) --begun;
  losses_.dropped_disconnect += begun;
}

void Connection::look_at_reader(TimePoint now) {
  auto look = look_at_peer(writer_.descriptor());
  look_due_ = look.must_answer ? now + look.next : TimePoint::max();
  if (look.vanished) lose_connection({Code::Closed, "the reader does not respond"}, now);
}

/// Checks whether the connection has failed. The event that led here may be of an earlier one.
void Connection::check_connection(TimePoint now) {
  pollfd polled{writer_.descriptor(), 0, 0};
  if (!connected() || ::poll(&polled, 1, 0) <= 0) return;
  int number = 0;
  socklen_t size = sizeof number;
  ::getsockopt(writer_.descriptor(), SOL_SOCKET, SO_ERROR, &number, &size);
  lose_connection(number == 0 ? Error{Code::Closed, "the reader disconnected"}
                              : system_error("write", "", number),
                  now);
}

/// Called by the reactor.
void Connection::on_event(std::uint32_t events) {
  std::lock_guard lock(mutex_);
  flush_is_due_ = false;
  if (events != 0) wanted_ = 0;  // events are one-shot
  if (failed_ || waits_) return;
  const auto now = clock_now();
  if ((events & (EPOLLERR | EPOLLHUP)) != 0) check_connection(now);
  if (!connected() || blocked_ || due(now) <= now) advance(now);
  arm(now);
}

/// Has the reactor call on_event() when there is something to do.
void Connection::arm(TimePoint now) {
  if (failed_) return;
  want(static_cast<std::uint32_t>(awaited_events()));
  auto when = due(now);
  if (when == TimePoint::max()) return;
  flush_is_due_ = writer_.gathered() > 0;
  watch_.call_at(when);
}

/// The events to wait for, of the connection or the attempt to make one. Those of poll and epoll
/// have the same values.
short Connection::awaited_events() const {
  if (!connected()) return dialer_->events();
  if (blocked_) return POLLOUT;
  // Without a dialer the next write is soon enough to notice a lost connection.
  return dialer_ != nullptr ? POLLERR : 0;
}

/// Watches the descriptor for events, each reported once. Files cannot be watched, and need not be.
void Connection::want(std::uint32_t events) {
  if (std::exchange(wanted_, events) == events) return;
  static_cast<void>(watch_.want(events == 0 ? 0 : events | EPOLLONESHOT));
}

/// When there is something to do next, whatever the descriptor's events.
TimePoint Connection::due(TimePoint now) {
  if (failed_) return TimePoint::max();
  if (!connected()) return dialer_->due();
  auto when = look_due_;
  if (blocked_) return when;
  if (!writer_.empty()) when = std::min(when, flush_due());
  return std::min(when, queue_.ready_at(now, losses_));
}

/// Waits until everything is written.
/// @param message  being sent; null: the link is being closed, for which it need not be connected.
/// @param give_up  when to give up although a message is partly written.
Status Connection::drain(std::unique_lock<std::mutex>& lock, Outgoing* message,
                         std::optional<TimePoint> give_up) {
  const bool closing = message == nullptr;
  while (true) {
    auto now = clock_now();
    advance(now);
    if (failed_) return *failed_;
    if (all_written() && (connected() || closing)) break;
    if (give_up && now >= *give_up) {
      bool begun = writer_.inside_message();
      fail({begun ? Code::Truncated : Code::Stopped,
            begun ? "asked to stop, and the reader did not take the rest of a message"
                  : "asked to stop, and the reader did not take all messages"});
      return *failed_;
    }
    if (!give_up && !has_patience(now)) {
      if (closing) fail({Code::Closed, "the reader takes nothing"});
      if (closing) return *failed_;
      give_up_reader(*message);
      break;
    }
    remarks_.flush(log_);
    auto waited = wait(lock, give_up, now);
    if (waited) continue;
    if (waited.error().code != Code::Stopped) return waited.error();
    if (!closing && take_back()) {
      arm(now);
      return waited.error();
    }
    patience_.end();  // give_up limits the wait from now on
    give_up = clock_now() + kGrace;
  }
  arm(clock_now());
  return {};
}

/// Whether to go on waiting. A message that only waits for its turn does not wait for the reader.
bool Connection::has_patience(TimePoint now) {
  if (blocked_ || !connected()) return patience_.waits(writer_.total(), now);
  patience_.end();
  return true;
}

/// Drops the message being sent; one that was partly written is finished when the reader allows.
void Connection::give_up_reader(Outgoing& message) {
  if (take_back()) {
    ++losses_.dropped_timeout;
    losses_.bytes -= message.size();
  } else if (writer_.borrows()) {
    writer_.keep(message.kept());
  }
}

/// Drops a message if the reader was given up and has taken nothing since.
bool Connection::drops_for_reader(const Outgoing& message, TimePoint now) {
  if (connected() && all_written()) patience_.renew();
  if (!patience_.is_over(writer_.total())) return false;
  ++losses_.dropped_timeout;
  losses_.bytes -= message.size();
  arm(now);
  return true;
}

/// Removes the message being sent; false if it was partly written.
bool Connection::take_back() {
  if (queue_.empty()) return writer_.take_back();
  queue_.take_back();
  return true;
}

/// Waits for room, a connection, or the time when something is due.
Result<bool> Connection::wait(std::unique_lock<std::mutex>& lock, std::optional<TimePoint> give_up,
                              TimePoint now) {
  int descriptor = !connected() ? dialer_->descriptor() : blocked_ ? writer_.descriptor() : -1;
  if (wanted_ != EPOLLERR) want(0);  // this thread waits for it
  const auto until = std::min({due(now), patience_.due(), give_up.value_or(TimePoint::max())});
  const short events = awaited_events();
  waits_ = true;
  lock.unlock();
  auto waited = wait_for(descriptor, events, give_up ? -1 : stop_, until);
  lock.lock();
  waits_ = false;
  return waited;
}

Status Connection::close() {
  auto closed = close(true);
  remarks_.flush(log_);
  return closed;
}

Status Connection::close(bool patient) {
  std::unique_lock lock(mutex_);
  std::optional<TimePoint> give_up;
  if (!patient) give_up = clock_now();
  Status closed = failed_ ? Status(*failed_) : drain(lock, nullptr, give_up);
  patience_.end();
  stop_watching();
  const bool is_connected = connected();
  if (!failed_) failed_ = Error{Code::Closed, "the link was closed"};
  lock.unlock();
  if (is_connected) writer_.close(closed ? kGrace : std::chrono::seconds(0));
  return closed;
}

void Connection::abandon() {
  std::lock_guard lock(mutex_);
  if (failed_) return;
  if (connected()) static_cast<void>(writer_.write());
  fail({Code::Closed, "the link was closed"});
}

Traffic Connection::traffic() const {
  Traffic traffic = losses();
  traffic.messages = messages_;
  traffic.bytes += bytes_;
  return traffic;
}

std::optional<std::size_t> Connection::peers() {
  std::lock_guard lock(mutex_);
  return connected() ? 1 : 0;
}

bool Connection::is_behind() const {
  std::lock_guard lock(mutex_);
  return blocked_ || !queue_.empty();
}

Traffic Connection::losses() const {
  std::lock_guard lock(mutex_);
  return losses_;
}

bool Connection::has_failed() const {
  std::lock_guard lock(mutex_);
  return failed_.has_value();
}

Result<std::unique_ptr<Sink>> make_stream_sink(ConnectedSocket descriptor, const Uri& uri,
                                               const LinkOptions& options,
                                               std::unique_ptr<Dialer> dialer) {
  auto policy = HC_TRY(parse_policy(uri));
  std::unique_ptr<Sink> sink =
      HC_TRY(Connection::make(std::move(descriptor), policy, options, std::move(dialer)));
  return sink;
}

}  // namespace hc::internal
