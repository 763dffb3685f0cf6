// SPDX-License-Identifier: Apache-2.0
// Finds room for messages: reuses cells and slots that no reader needs, and waits for readers.
#include <hc/link/shm/sink.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include <hc/link/shm/crash_point.h>
#include <hc/link/stream/source.h>

namespace hc::internal {
namespace {

using std::memory_order_acquire;
using std::memory_order_relaxed;
using std::memory_order_release;
using std::memory_order_seq_cst;

/// How far a lossless publisher gets ahead of its slowest reader: messages are then still in the
/// caches when they are read.
constexpr std::uint64_t kAheadBytes = std::uint64_t{8} << 20;
constexpr std::uint64_t kAheadMessages = 2;  // at least, whatever their size
constexpr std::uint64_t kBatch = 64;         // cells that are withdrawn together
/// How often a wait checks whether it is to stop.
constexpr std::chrono::milliseconds kStopCheckPeriod{20};

}  // namespace

void ShmSink::meet_readers() {
  readers_->refresh();
  readers_->remarks().flush(options_.log);
  const auto& readers = readers_->current();
  present_ = static_cast<std::size_t>(std::count_if(
      readers.begin(), readers.end(), [](const auto& reader) { return !reader->left(); }));
  waker_.meet(readers);
}

/// refresh() that includes every reader which may know its first position; to be called before
/// messages are withdrawn.
void ShmSink::refresh_for_sure() {
  std::atomic_thread_fence(memory_order_seq_cst);
  refresh();
}

Status ShmSink::await_readers() {
  return audience_.await(readers_->event(), options_, [this]() -> Result<std::size_t> {
    if (ended_) return abandoned();
    refresh();
    return present_;
  });
}

/// Whether another `bytes` in slots are too many for the slowest lossless reader. Reads the cursors
/// only if it seems so from the last ones.
bool ShmSink::is_too_far_ahead(std::uint64_t bytes) {
  auto seems_so = [&] {
    return published_ - taken_ >= kAheadMessages &&
           slot_bytes_ + bytes - ahead_[taken_ % kCells] > kAheadBytes;
  };
  taken_ = std::max(taken_, oldest_);
  if (!seems_so()) return false;
  taken_ = std::max(readers_->taken_by_all(published_), oldest_);
  return seems_so();
}

/// Waits until the slowest reader has caught up, to half of the limit, since a wake-up is
/// expensive.
Status ShmSink::let_catch_up(std::uint64_t bytes) {
  auto wanted = taken_ + 1;
  while (wanted + 1 < published_ && slot_bytes_ + bytes - ahead_[wanted % kCells] > kAheadBytes / 2)
    ++wanted;
  return wait_for_room(wanted, [&] { return readers_->taken_by_all(published_) >= wanted; });
}

/// Waits until `has_room()`, or all readers to wait for have been given up.
Status ShmSink::wait_for_room(std::uint64_t wanted, const std::function<bool()>& has_room) {
  struct Wish {
    Head& head;
    const std::unique_ptr<ShmReaders>& readers;  // null once the link was abandoned meanwhile
    ~Wish() {
      head.wanted.store(0, memory_order_relaxed);
      if (readers) readers->end_waits();
    }
  } wish{head_, readers_};
  head_.wanted.store(wanted, memory_order_relaxed);
  while (true) {
    refresh();
    const auto reader = readers_->blocker(published_);  // shared, since refresh() may remove it
    auto progress = reader == nullptr ? 0 : reader->page().progress.load(memory_order_acquire);
    std::atomic_thread_fence(memory_order_seq_cst);  // room
    if (has_room()) return {};
    if (readers_->changed()) continue;
    if (reader == nullptr && readers_->have_given_up()) return {};
    if (reader == nullptr && !host_)
      return Error{Code::System,
                   "no room left: the host is out of shared memory: " + host_.error().detail};
    if (reader == nullptr)
      return Error{Code::TooLarge, "no room left: this program holds all of the memory"};
    const auto now = std::chrono::steady_clock::now();
    if (!reader->patience.waits(reader->cursor(published_), now)) continue;
    HC_CRASH_POINT("publisher waits for room");
    futex_wait(reader->page().progress, progress, kStopCheckPeriod);
    HC_TRY(wait_for_event(-1, options_, now));
    if (ended_) return abandoned();
  }
}

/// Withdraws the cells below `end`: readers skip them.
void ShmSink::withdraw(std::uint64_t end) {
  if (end <= oldest_) return;
  head_.oldest.store(end, memory_order_release);
  HC_CRASH_POINT("publisher withdrew");
  for (; oldest_ < end; ++oldest_)
    if (Slot*& slot = slot_of_cell_[oldest_ % kCells]; slot != nullptr) {
      --slot->cells;
      slot = nullptr;
    }
}

/// Returns slots to the pool that no message refers to and no reader holds.
void ShmSink::sweep() {
  refresh_for_sure();  // hold
  std::vector<std::uint64_t> held;
  for (const auto& reader : readers_->current())
    for (const auto& slot : reader->page().held)
      if (auto begin = slot.load(memory_order_acquire); begin != 0) held.push_back(begin);
  slots_->sweep([&](const Slot& slot) {
    return !slot.referred_to() && std::find(held.begin(), held.end(), slot.begin) == held.end();
  });
  HC_CRASH_POINT("publisher swept");
}

/// Allocates the pages of a slot; null if the host has no memory for them.
Slot* ShmSink::reserve(Slot* slot) {
  if (slot == nullptr) return slot;
  host_ = memory_->reserve(slot->begin + slot->bytes);
  return host_ ? slot : nullptr;  // the next sweep returns it to the pool
}

/// A slot that no reader needs; null if there is none.
Slot* ShmSink::take_slot(std::uint64_t bytes) {
  if (Slot* slot = reserve(slots_->reuse(bytes)); slot != nullptr) return slot;
  refresh_for_sure();
  withdraw(readers_->wanted_by_none(published_));
  sweep();
  if (Slot* slot = reserve(slots_->reuse(bytes)); slot != nullptr) return slot;
  return reserve(slots_->allocate(bytes));
}

/// A slot, if necessary by withdrawing the oldest messages from lossy readers; null if lossless
/// ones need all others.
Slot* ShmSink::clear_slot(std::uint64_t bytes) {
  host_ = {};
  Slot* slot = take_slot(bytes);
  while (slot == nullptr && oldest_ < readers_->taken_by_all(published_)) {
    withdraw(oldest_ + 1);
    sweep();
    slot = reserve(slots_->reuse(bytes));
    if (slot == nullptr) slot = reserve(slots_->allocate(bytes));
  }
  return slot;
}

/// Finds the slot of elements, or copies them to one. Null: the message is dropped, since there is
/// no memory and the publisher does not wait.
Status ShmSink::place(const Message& message, Slot*& slot) {
  const std::byte* from = message.elements.data();
  auto bytes = message.elements.size();
  bool loaned = from >= memory_->data() + kSlotsBegin && from < memory_->data() + memory_->size();
  slot = loaned ? slots_->find(static_cast<std::uint64_t>(from - memory_->data())) : nullptr;
  if (slot != nullptr && bytes <= slot->bytes) return {};
  if (bytes > memory_->size() - kSlotsBegin)
    return Error{Code::TooLarge,
                 "a message of " + std::to_string(bytes) +
                     " bytes does not fit memory=" + std::to_string(memory_->size())};
  slot = clear_slot(bytes);
  if (slot == nullptr && keep_ == 0) {
    HC_TRY(wait_for_room(Head::kAnyRoom, [&] {
      slot = clear_slot(bytes);
      return slot != nullptr;
    }));
  }
  if (slot == nullptr) return {};
  HC_CRASH_POINT("publisher has slot");
  std::memcpy(memory_->data() + slot->begin, from, bytes);
  HC_CRASH_POINT("publisher filled slot");
  return {};
}

/// Makes sure that the next cell is free.
Status ShmSink::make_cell_free() {
  refresh_for_sure();
  withdraw(std::min(readers_->taken_by_all(published_), published_ - kCells + kBatch));
  if (published_ - oldest_ < kCells) return {};
  // Half of the ring at once, since a wake-up is expensive.
  auto wanted = published_ - kCells / 2;
  auto room = wait_for_room(wanted, [&] { return readers_->taken_by_all(published_) >= wanted; });
  if (room) withdraw(std::min(readers_->taken_by_all(published_), published_ - kCells + kBatch));
  return room;
}

}  // namespace hc::internal
