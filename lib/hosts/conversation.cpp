// SPDX-License-Identifier: Apache-2.0
#include <hosts/conversation.h>

#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include <hc/base/clock.h>
#include <hc/mtp/codec.h>
#include <hc/mtp/rows.h>
#include <hc/os/descriptor.h>

namespace hc::hosts {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostInATurn = 64;  // pieces, so that a busy peer does not block the loop

}  // namespace

MonotonicTime monotonic_now() {
  return SystemClock().monotonic();
}

/// Two clocks cannot be read at once: uses the fastest of three attempts.
std::chrono::nanoseconds monotonic_to_wall() {
  auto best = MonotonicTime(0), best_width = MonotonicTime::max();
  for (int i = 0; i < 3; ++i) {
    const auto before = monotonic_now(), wall = SystemClock().wall().time_since_epoch(),
               after = monotonic_now();
    if (after - before >= best_width) continue;
    best_width = after - before;
    best = wall - (before + best_width / 2);
  }
  return best;
}

Message make_order(const Json& order) {
  auto message = make_rows(std::array{order.dump(-1, ' ', false, Json::error_handler_t::replace)});
  message.header.src = Order;
  return message;
}

Json read_order(const Message& message) {
  const auto rows = rows_of(message);
  if (rows.size() != 1) return nullptr;
  auto order = Json::parse(rows.front(), nullptr, false);
  const bool is_order = order.is_object() && order.contains("what") && order["what"].is_string();
  return is_order ? order : Json(nullptr);
}

Message make_bytes(std::string_view bytes, std::int64_t process) {
  Draft draft = Draft::make({MatrixType::Table, 1, Scalar::U8, Encoding::Binary},
                            static_cast<std::int32_t>(bytes.size()), 1);
  std::memcpy(draft.elements().data(), bytes.data(), bytes.size());
  draft.header.src = Log;
  draft.header.dst = static_cast<std::int32_t>(process);
  return std::move(draft).finish();
}

Result<std::unique_ptr<Conversation>> Conversation::make(Loop& loop, int in, int out,
                                                         std::chrono::milliseconds patience,
                                                         Callbacks callbacks) {
  std::unique_ptr<Conversation> made(new Conversation(in, out, std::move(callbacks)));
  auto* self = made.get();
  self->heard_ = Clock::now();
  self->patience_ = patience;
  self->readable_ = HC_TRY(loop.watch(in, EPOLLIN, [self](auto) { self->read(); }));
  self->writable_ = HC_TRY(loop.watch(out, 0, [self](auto) { self->write(); }));
  self->silence_ = loop.call_at(self->heard_ + patience, [self] {
    if (self->is_stuck_) return self->end("it does not read its messages");
    const auto due = self->heard_ + self->patience_;
    if (Clock::now() < due) return self->silence_.call_at(due);
    self->end("no answer for " + std::to_string(self->patience_.count() / 1000) + " s");
  });
  return made;
}

void Conversation::send(const Message& message) {
  if (is_over_) return;
  waiting_ += encode(message);
  write();
}

void Conversation::write() {
  while (!is_over_ && !waiting_.empty()) {
    const ssize_t size = ::write(out_, waiting_.data(), waiting_.size());
    if (size > 0) {
      waiting_.erase(0, static_cast<std::size_t>(size));
    } else if (size < 0 && errno == EINTR) {
      continue;
    } else {
      break;  // read() handles errors, after any last message
    }
  }
  if (waiting_.size() > kTooMuch) {
    waiting_.clear();
    is_stuck_ = true;
    silence_.call_at(Clock::now());
  }
  static_cast<void>(writable_.want(waiting_.empty() ? 0U : EPOLLOUT));
}

void Conversation::read() {
  Message message;
  for (int piece = 0; piece < kMostInATurn && !is_over_; ++piece) {
    while (true) {
      auto got = reader_.next(message);
      if (!got) return end(std::string(kNoMessage) + ": " + got.error().detail);
      if (!*got) break;
      heard_ = Clock::now();
      if (std::exchange(patience_, kSilence) != kSilence) silence_.call_at(heard_ + patience_);
      callbacks_.take(message);
      if (is_over_) return;
    }
    const auto space = reader_.space();
    const ssize_t size = ::read(in_, space.data(), space.size());
    if (size == 0) return end(std::string(kEnded));
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) return;
    if (size < 0) return end(system_error("read", "agent").detail);
    reader_.commit(static_cast<std::size_t>(size));
  }
}

void Conversation::close() {
  is_over_ = true;
  static_cast<void>(readable_.want(0));
  static_cast<void>(writable_.want(0));
  silence_.reset();
}

void Conversation::end(const std::string& why) {
  if (is_over_) return;
  close();
  callbacks_.ended(why);
}

}  // namespace hc::hosts
