// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/source.h>

#include <fcntl.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>

#include <hc/link/shm/crash_point.h>
#include <hc/mtp/framing.h>

namespace hc::internal {
namespace {

using std::memory_order_acquire;
using std::memory_order_relaxed;
using std::memory_order_release;
using std::memory_order_seq_cst;

/// After how many small messages a reader looks at Head::wanted.
constexpr std::uint64_t kLookEvery = 64;
constexpr std::size_t kCopyHold = kMostHeld - 1;
constexpr std::size_t kNoHold = kMostHeld;
constexpr unsigned kDrainEvery = 1024;  // waits; each leaves at most one byte in the pipe
constexpr unsigned kLookSeldom = 8;     // waits without a message, until it checks its connection
constexpr int kMostSkips = 64;  // until a reader that is overtaken repeatedly returns to its caller

/// Releases the slot of a message.
struct LetGo {
  std::shared_ptr<Attachment> attachment;
  std::size_t hold;
  void operator()(const void*) const { attachment->let_go(hold); }
};

Error damaged(const std::string& what) {
  return {Code::Malformed, "the publisher's memory is damaged: " + what};
}

}  // namespace

Result<std::shared_ptr<const Descriptor>> make_wake_pipe() {
  std::array<int, 2> ends;
  HC_TRY(system_call("pipe2", "", [&] { return ::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC); }));
  Descriptor writer(ends[1]);  // publishers open their own
  return std::make_shared<const Descriptor>(ends[0]);
}

ShmSource::~ShmSource() {
  attachment_->own().cursor.store(ReaderPage::kLeft, memory_order_release);
  HC_CRASH_POINT("reader left");
  ::shutdown(attachment_->socket.get(), SHUT_WR);
}

/// Skips messages, and counts them as lost.
void ShmSource::skip_to(std::uint64_t position, std::uint64_t Traffic::*why) {
  if (position <= cursor_) return;
  traffic_.*why += position - cursor_;
  cursor_ = position;
}

/// Skips withdrawn messages. Those that this reader wanted to keep are lost because there was no
/// memory or cell for them.
void ShmSource::skip_withdrawn(std::uint64_t oldest) {
  auto published = attachment_->head().published.load(memory_order_acquire);
  if (keep_ == 0) return skip_to(oldest, &Traffic::dropped_timeout);
  if (published > keep_) skip_to(std::min(oldest, published - keep_), &Traffic::dropped_newer);
  skip_to(oldest, &Traffic::dropped_memory);
}

/// Copies a cell; false if it is invalid, or is being overwritten.
bool ShmSource::copy(Copy& cell) const {
  const Cell& shared = attachment_->cell(cursor_);
  cell.slot = shared.slot.load(memory_order_relaxed);
  auto sizes = shared.sizes.load(memory_order_relaxed);
  cell.header_bytes = sizes & 0xffff;
  cell.bytes = sizes >> 16;
  auto bytes = cell.slot == 0 ? Cell::behind(cell.header_bytes) + cell.bytes : cell.header_bytes;
  if (bytes > Cell::kTextBytes) return false;
  for (std::size_t i = 0; i * sizeof(std::uint64_t) < bytes; ++i)
    cell.words[i] = shared.text[i].load(memory_order_relaxed);
  return true;
}

/// Holds a slot. If all others are in use, by the last entry, which is for messages to be copied.
std::size_t ShmSource::take_hold(std::uint64_t slot) {
  auto& held = attachment_->own().held;
  std::size_t index = 0;
  while (index < kCopyHold && held[index].load(memory_order_acquire) != 0) ++index;
  held[index].store(slot, memory_order_relaxed);
  return index;
}

/// Makes a message from the copy of a cell, whose slot is held.
Status ShmSource::deliver(const Copy& cell, Message& message, std::size_t hold) {
  std::string_view line(cell.text(), cell.header_bytes);
  if (!line.ends_with('\n')) return damaged("a header without a line feed");
  line.remove_suffix(1);
  auto parsed = memo_.parse(line, options_.limits, traffic_.bytes);
  if (!parsed) return parsed.error();
  const Header& header = *parsed;
  bool right = is_compressed(header) ? cell.bytes <= options_.limits.element_bytes
                                     : cell.bytes == header.element_bytes();
  if (!right) return damaged(std::to_string(cell.bytes) + " bytes of elements for " + text(header));
  const auto& memory = attachment_->memory;
  if (hold != kNoHold && (cell.slot < kSlotsBegin || cell.slot % kLine != 0 ||
                          cell.slot >= memory.size() || cell.bytes > memory.size() - cell.slot))
    return damaged("invalid offset of a slot");
  message.header = header;
  message.byte = traffic_.bytes;
  ++traffic_.messages;
  traffic_.bytes += cell.header_bytes + cell.bytes;
  if (hold == kNoHold) {
    auto room = allocate_bytes(cell.bytes);
    std::memcpy(room.get(), cell.text() + Cell::behind(cell.header_bytes), cell.bytes);
    message.elements = {room.get(), cell.bytes};
    message.owner = std::move(room);
    return {};
  }
  const std::byte* from = memory.data() + cell.slot;
  message.elements = {from, cell.bytes};
  if (hold < kCopyHold) {
    message.owner = std::shared_ptr<const void>(from, LetGo{attachment_, hold});
    return {};
  }
  if (!told_ && options_.log)
    options_.log(Level::Warning,
                 std::to_string(kCopyHold) + " messages are held; others are copied meanwhile");
  told_ = true;
  message = message.keep();
  attachment_->let_go(hold);
  return {};
}

Result<Got> ShmSource::take(Message& message) {
  message.owner.reset();
  message.elements = {};
  if (!attached()) {
    auto offer = take_offer(attachment_->socket.get());
    if (!offer) return Error{Code::Closed, offer.error().detail};
    if (!offer->has_value()) return Got::Nothing;
    attach(std::move(**offer));
  }
  const Head& head = attachment_->head();
  for (int tries = 0; tries < kMostSkips; ++tries) {
    if (keep_ > 0) {
      auto published = head.published.load(memory_order_acquire);
      if (published > cursor_ && published - cursor_ > keep_)
        skip_to(published - keep_, &Traffic::dropped_newer);
    }
    auto stamp = attachment_->cell(cursor_).stamp.load(memory_order_acquire);
    if (stamp <= cursor_ && !has_ended()) return Got::Nothing;
    if (stamp <= cursor_ && head.closed.load(memory_order_acquire) == 0)
      return Error{Code::Closed, "the publisher has died"};
    if (stamp <= cursor_) return Got::End;
    if (stamp == cursor_ + 1) {
      fetch_ahead();
      Copy cell;
      bool fits = copy(cell);
      HC_CRASH_POINT("reader copied");
      auto hold = cell.slot == 0 ? kNoHold : take_hold(cell.slot);
      if (!is_withdrawn(hold != kNoHold)) {
        finish_cell(cell.slot != 0);
        auto delivered = fits ? deliver(cell, message, hold) : damaged("invalid sizes of a cell");
        if (!delivered) {
          if (hold != kNoHold) attachment_->let_go(hold);
          return delivered.error();
        }
        return Got::Message;
      }
      if (hold != kNoHold) attachment_->let_go(hold);
    }
    auto oldest = head.oldest.load(memory_order_acquire);
    if (oldest <= cursor_) return damaged("invalid stamp of a cell");
    skip_withdrawn(oldest);
  }
  return Got::Nothing;  // the publisher is faster; wait() returns at once
}

/// Prefetches one of the next cells, if it is published.
void ShmSource::fetch_ahead() {
  if (cursor_ >= known_ && cursor_ % kFetchAhead == 0)
    known_ = attachment_->head().published.load(memory_order_relaxed);
  if (cursor_ + kFetchAhead >= known_) return;
  const Cell& later = attachment_->cell(cursor_ + kFetchAhead);
  for (std::size_t line = 0; line < kFetchBytes; line += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&later) + line);
}

/// Whether the cell was withdrawn before it was copied or its slot was held.
bool ShmSource::is_withdrawn(bool holds) const {
  std::atomic_thread_fence(holds ? memory_order_seq_cst : memory_order_acquire);  // hold
  return attachment_->head().oldest.load(memory_order_acquire) > cursor_;
}

/// Advances the cursor. A publisher that reads it also sees the slots held before.
void ShmSource::finish_cell(bool has_slot) {
  HC_CRASH_POINT("reader holds");
  ++cursor_;
  attachment_->own().cursor.store(cursor_, memory_order_release);
  HC_CRASH_POINT("reader took");
  if (armed_) disarm();
  if (keep_ > 0 || !(has_slot || cursor_ % kLookEvery == 0)) return;
  std::atomic_thread_fence(memory_order_seq_cst);  // room
  attachment_->offer_cells();
}

void ShmSource::attach(Offer offer) {
  attachment_->memory = std::move(offer.memory);
  attachment_->own().cursor.store(offer.begin, memory_order_release);
  cursor_ = offer.begin;
  keep_ = offer.keep;
}

Source::Spin ShmSource::spin() const {
  if (!attached()) return {};
  // While it spins, the publisher cannot run on the same processor.
  const auto processor = attachment_->head().processor.load(memory_order_relaxed);
  if (processor == static_cast<std::uint32_t>(::sched_getcpu())) return {};
  return {&attachment_->cell(cursor_).stamp, cursor_ + 1, spin_};
}

bool ShmSource::is_ready() const {
  return attachment_->cell(cursor_).stamp.load(memory_order_acquire) > cursor_ || has_ended();
}

/// Checks whether the publisher has left.
void ShmSource::look_at_socket() {
  char byte;
  auto size = ::recv(attachment_->socket.get(), &byte, 1, MSG_DONTWAIT);
  if (size >= 0 || (errno != EAGAIN && errno != EINTR)) publisher_gone_ = true;
}

void ShmSource::drain_pipe() const {
  std::array<char, std::size_t{2} * kDrainEvery> bytes;
  [[maybe_unused]] const auto size = ::read(wake_descriptor(), bytes.data(), bytes.size());
}

bool ShmSource::prepare_wait() {
  if (!attached()) return true;
  // If it is still armed, it was woken by another link, or by the end of this connection.
  if (armed_ && ++vain_waits_ % kLookSeldom == 0) look_at_socket();
  if (++arming_ % kDrainEvery == 0) drain_pipe();
  if (arming_ == 0) ++arming_;
  attachment_->own().armed.store(arming_, memory_order_relaxed);
  armed_ = true;
  HC_CRASH_POINT("reader armed");
  std::atomic_thread_fence(memory_order_seq_cst);  // wake
  if (attachment_->head().unfenced.load(memory_order_acquire) != 0) order_everywhere();
  if (!is_ready()) return true;
  disarm();
  return false;
}

}  // namespace hc::internal

namespace hc {

bool is_lent(const Message& message) {
  return std::get_deleter<internal::LetGo>(message.owner) != nullptr;
}

}  // namespace hc
