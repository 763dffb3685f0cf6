// SPDX-License-Identifier: Apache-2.0
// Publishes messages: in a cell, or a cell and a slot if they are large.
#include <hc/link/shm/sink.h>

#include <sched.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

#include <hc/link/shm/crash_point.h>
#include <hc/mtp/digits.h>

namespace hc::internal {
namespace {

using std::memory_order_relaxed;
using std::memory_order_release;
using std::memory_order_seq_cst;

static_assert(std::endian::native == std::endian::little);

/// Copies bytes word by word, and fills the last word. Most of them have just been written word by
/// word: a wider load could not be forwarded from these stores, and would wait until all stores
/// before it have reached the cache, including those to cells that another processor has.
void copy_words(std::span<const std::byte> bytes, char* to) {
  const auto* from = reinterpret_cast<const char*>(bytes.data());
  std::size_t i = 0;
  for (; i + sizeof(std::uint64_t) <= bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = load8(from + i);
    std::memcpy(to + i, &word, sizeof word);
  }
  std::uint64_t rest = 0;
  for (std::size_t end = bytes.size(); end > i; --end)
    rest = rest << 8 | static_cast<unsigned char>(from[end - 1]);
  std::memcpy(to + i, &rest, sizeof rest);
}

}  // namespace

Status ShmSink::send(const Message& message) {
  if (ended_) return abandoned();
  refresh();
  auto fate = audience_.decide(present_);
  for (; fate == Audience::Fate::Kept; fate = audience_.decide(present_)) HC_TRY(await_readers());
  if (fate == Audience::Fate::End) return Error{Code::Closed, "the readers disconnected"};
  if (fate == Audience::Fate::Lost) {
    audience_.count_lost(traffic_);
    return {};
  }
  // The header line, followed by the elements if they are small, in words.
  std::array<std::uint64_t, Cell::kWords + kMaxHeaderBytes / sizeof(std::uint64_t)> words;
  char* text = reinterpret_cast<char*>(words.data());
  auto header_bytes =
      memo_.format(message.header, std::span<char, kMaxHeaderBytes>(text, kMaxHeaderBytes));
  auto bytes = message.elements.size();
  auto text_bytes = Cell::behind(header_bytes);
  Slot* slot = nullptr;
  if (text_bytes + bytes <= Cell::kTextBytes) {
    copy_words(message.elements, text + text_bytes);
    text_bytes += bytes;
  } else {
    if (is_too_far_ahead(bytes)) HC_TRY(let_catch_up(bytes));
    HC_TRY(place(message, slot));
    if (slot == nullptr) {
      ++traffic_.messages;
      ++traffic_.dropped_memory;
      return {};
    }
    ++slot->cells;
  }
  if (published_ - oldest_ == kCells)
    if (auto freed = make_cell_free(); !freed) {
      if (slot != nullptr) --slot->cells;
      return freed;
    }
  ahead_[published_ % kCells] = slot_bytes_;
  if (slot != nullptr) slot_bytes_ += bytes;
  slot_of_cell_[published_ % kCells] = slot;
  publish({words.data(), (text_bytes + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t)},
          bytes << 16 | header_bytes, slot);
  ++traffic_.messages;
  traffic_.bytes += header_bytes + bytes;
  return {};
}

void ShmSink::publish(std::span<const std::uint64_t> text, std::uint64_t sizes, Slot* slot) {
  Cell& cell = cells_[published_ % kCells];
  const Cell& later = cells_[(published_ + kFetchAhead) % kCells];
  for (std::size_t line = 0; line < kFetchBytes; line += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&later) + line, 1);
  // A slow reader that is copying this cell will find that `oldest` has passed it.
  std::atomic_thread_fence(memory_order_release);
  cell.slot.store(slot == nullptr ? 0 : slot->begin, memory_order_relaxed);
  cell.sizes.store(sizes, memory_order_relaxed);
  for (std::size_t i = 0; i < text.size(); ++i) cell.text[i].store(text[i], memory_order_relaxed);
  HC_CRASH_POINT("publisher wrote cell");
  ++published_;
  cell.stamp.store(published_, memory_order_release);
  HC_CRASH_POINT("publisher stamped");
  head_.processor.store(static_cast<std::uint32_t>(::sched_getcpu()), memory_order_relaxed);
  head_.published.store(published_, memory_order_release);
  HC_CRASH_POINT("publisher published");
  if (waker_.must_fence()) std::atomic_thread_fence(memory_order_seq_cst);  // wake
  std::atomic_signal_fence(memory_order_seq_cst);
  refresh();
  waker_.wake(*readers_);
  HC_CRASH_POINT("publisher woke readers");
}

Draft ShmSink::loan(const Header& header) {
  auto bytes = header.element_bytes();
  if (ended_) return Sink::loan(header);
  refresh();
  // Behind a header line of usual length the elements fit into a cell.
  if (bytes <= Cell::kTextBytes - kLine) return Sink::loan(header);
  Slot* slot = take_slot(bytes);
  if (slot == nullptr) return Draft::make(header);
  HC_CRASH_POINT("publisher loaned");
  ++slot->messages;
  return Draft::make(header, SharedBytes(memory_->data() + slot->begin,
                                         [slot, memory = memory_, slots = slots_](std::byte*) {
                                           slot->messages.fetch_sub(1, memory_order_release);
                                         }));
}

Status ShmSink::close() {
  Status awaited;
  if (audience_.is_awaited()) awaited = await_readers();
  if (readers_ != nullptr) refresh();  // writes to the log
  end();
  return awaited;
}

/// Readers keep the memory, and can take the rest of the messages without the publisher.
void ShmSink::end() {
  if (ended_ || readers_ == nullptr) return;
  ended_ = true;
  head_.closed.store(1, memory_order_release);
  HC_CRASH_POINT("publisher closed");
  readers_.reset();  // closes the connections, which wakes sleeping readers
}

}  // namespace hc::internal
