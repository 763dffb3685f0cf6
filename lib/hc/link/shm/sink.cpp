// SPDX-License-Identifier: Apache-2.0
// The publisher of `shm:NAME`.
#include <sys/socket.h>

#include <array>
#include <bit>
#include <cstring>
#include <functional>

#include <hc/link/paced_sink.h>
#include <hc/link/shm/crash_point.h>
#include <hc/link/shm/readers.h>
#include <hc/link/shm/slots.h>
#include <hc/link/shm/waker.h>
#include <hc/link/stream_link.h>
#include <hc/link/transports.h>
#include <hc/link/unix.h>
#include <hc/wire/digits.h>
#include <hc/wire/header_memo.h>

namespace hc::internal {
namespace {

static_assert(std::endian::native == std::endian::little);

using std::memory_order_acquire;
using std::memory_order_relaxed;
using std::memory_order_release;
using std::memory_order_seq_cst;

/// How far a publisher that loses nothing gets ahead of its slowest reader: what it writes then is
/// in the caches still when it is read.
constexpr std::uint64_t kAheadBytes = std::uint64_t{8} << 20;
constexpr std::uint64_t kAheadMessages = 2;  // at least, however large
constexpr std::uint64_t kBatch = 64;         // cells that are withdrawn together
/// How often one who waits looks whether it is to stop.
constexpr std::chrono::milliseconds kLookPeriod{20};

/// Copies bytes word by word, as they were mostly written; fills the last word. A larger load finds
/// none of the stores before it whole and waits until all of them have reached the cache, those
/// into cells too that another processor has.
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

class ShmSink final : public Sink {
 public:
  ShmSink(SharedMemory memory, std::int64_t counted, bool stays, std::uint64_t keep,
          LinkOptions options)
      : memory_(std::make_shared<SharedMemory>(std::move(memory))),
        head_(*reinterpret_cast<Head*>(memory_->data())),
        cells_(reinterpret_cast<Cell*>(memory_->data() + kRingBegin)),
        slots_(std::make_shared<SlotPool>(kSlotsBegin, memory_->size())),
        counted_(counted),
        stays_(stays),
        keep_(keep),
        log_(std::move(options.log)),
        stop_(options.stop),
        awaits_reader_(std::move(options.awaits_reader)) {}
  ~ShmSink() override { end(); }

  Status begin(ListeningSocket socket) {
    auto readers = ShmReaders::make(std::move(socket), *memory_, keep_);
    if (!readers) return readers.error();
    readers_ = std::move(*readers);
    return {};
  }

  Status send(const Message& message) override;
  Draft loan(const Header& header) override;
  Status close() override;
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  void refresh();
  void refresh_for_sure();
  Status await_readers(std::size_t count);
  Status wait_for_room(std::uint64_t wanted, const std::function<bool()>& has_room);
  Status make_cell_free();
  Status place(const Message& message, Slot*& slot);
  Slot* take_slot(std::uint64_t bytes);
  Slot* clear_slot(std::uint64_t bytes);
  Slot* reserve(Slot* slot);
  void withdraw(std::uint64_t end);
  void sweep();
  void publish(std::span<const std::uint64_t> text, std::uint64_t sizes, Slot* slot);
  void end();

  [[nodiscard]] bool is_too_far_ahead(std::uint64_t bytes);

  // Readers' messages outlive the sink, and so may those of this process that own slots.
  std::shared_ptr<SharedMemory> memory_;
  Head& head_;
  Cell* cells_;
  std::shared_ptr<SlotPool> slots_;
  std::unique_ptr<ShmReaders> readers_;
  std::int64_t counted_;
  bool stays_;  // when all of them have left
  std::uint64_t keep_;
  LogSink log_;
  int stop_;
  std::function<void(bool)> awaits_reader_;

  std::uint64_t published_ = 0, oldest_ = 0;  // as in head_
  std::array<Slot*, kCells> slot_of_cell_{};
  std::array<std::uint64_t, kCells> ahead_{};  // bytes in slots, sent before the message of a cell
  std::uint64_t slot_bytes_ = 0;               // the same of the next message
  std::uint64_t taken_ = 0;                    // by all, at the last look
  HeaderMemo memo_;
  Waker waker_{head_};
  std::size_t present_ = 0;  // readers that still take messages
  bool begun_ = false, ended_ = false;
  Status host_;  // whether it had pages for the last slot
  Traffic traffic_;
};

/// Learns who has come and gone. Cost: next to nothing when nobody has.
void ShmSink::refresh() {
  if (!readers_->changed()) return;
  readers_->refresh();
  readers_->remarks().tell(log_);
  const auto& readers = readers_->current();
  present_ = static_cast<std::size_t>(std::count_if(
      readers.begin(), readers.end(), [](const auto& reader) { return !reader->left(); }));
  waker_.meet(readers);
}

/// The same for sure, of all who could have been told where they begin; before one takes back what
/// they are to have.
void ShmSink::refresh_for_sure() {
  std::atomic_thread_fence(memory_order_seq_cst);
  refresh();
}

/// Whether `bytes` more in slots are too many for the slowest of those that lose nothing. Cost: a
/// look at what each has taken, but only when it seems so from the last look.
bool ShmSink::is_too_far_ahead(std::uint64_t bytes) {
  auto seems_so = [&] {
    return published_ - taken_ >= kAheadMessages &&
           slot_bytes_ + bytes - ahead_[taken_ % kCells] > kAheadBytes;
  };
  taken_ = std::max(taken_, oldest_);
  if (!seems_so()) return false;
  taken_ = readers_->taken_by_all(published_);
  return seems_so();
}

Status ShmSink::await_readers(std::size_t count) {
  refresh();
  const bool awaits = present_ < count && awaits_reader_;
  if (awaits) awaits_reader_(true);
  for (; present_ < count; refresh()) {
    auto changed = wait_for(readers_->event(), POLLIN, stop_);
    if (!changed) return changed.error();
  }
  if (awaits) awaits_reader_(false);
  return {};
}

/// Waits until `has_room()`, or the readers that were counted have left.
Status ShmSink::wait_for_room(std::uint64_t wanted, const std::function<bool()>& has_room) {
  struct Wish {
    Head& head;
    ~Wish() { head.wanted.store(0, memory_order_relaxed); }
  } wish{head_};
  head_.wanted.store(wanted, memory_order_relaxed);
  while (true) {
    refresh();
    const auto reader =
        readers_->blocker(published_);  // kept, since it may go while one looks for room
    auto progress = reader == nullptr ? 0 : reader->page().progress.load(memory_order_acquire);
    std::atomic_thread_fence(memory_order_seq_cst);  // room
    if (has_room()) return {};
    if (readers_->changed()) continue;
    if (reader == nullptr && !host_)
      return Error{Code::System,
                   "no room left: the host has no memory to share: " + host_.error().detail};
    if (reader == nullptr)
      return Error{Code::TooLarge, "no room left: this program holds all of the memory"};
    HC_CRASH_POINT("publisher waits for room");
    futex_wait(reader->page().progress, progress, kLookPeriod);
    auto stop = wait_readable({}, stop_, std::chrono::milliseconds(0));
    if (!stop) return stop.error();
  }
}

/// Takes cells below `end` back: readers that come to them skip them.
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

/// Finds out which slots nobody refers to or holds any more.
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

/// Sees that a slot's pages are there; null when the host has no memory for them.
Slot* ShmSink::reserve(Slot* slot) {
  if (slot == nullptr) return slot;
  host_ = memory_->reserve(slot->begin + slot->bytes);
  return host_ ? slot : nullptr;  // the next sweep takes it back, and it is tried again
}

/// A slot, without taking from a reader what it wants; null when there is none.
Slot* ShmSink::take_slot(std::uint64_t bytes) {
  if (Slot* slot = reserve(slots_->reuse(bytes)); slot != nullptr) return slot;
  refresh_for_sure();
  withdraw(readers_->wanted_by_none(published_));
  sweep();
  if (Slot* slot = reserve(slots_->reuse(bytes)); slot != nullptr) return slot;
  return reserve(slots_->allocate(bytes));
}

/// A slot, for which the readers that lose messages lose what they have not taken, the oldest
/// first; null when those that lose none want or hold all the rest.
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

/// Finds a slot for elements, and copies them if they are not in one already. Null: the message is
/// lost, as there is no memory for it and one does not wait.
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
    auto room = wait_for_room(Head::kAnyRoom, [&] {
      slot = clear_slot(bytes);
      return slot != nullptr;
    });
    if (!room) return room;
  }
  if (slot == nullptr) return {};
  HC_CRASH_POINT("publisher has slot");
  std::memcpy(memory_->data() + slot->begin, from, bytes);
  HC_CRASH_POINT("publisher filled slot");
  return {};
}

/// Sees that the next message has a cell.
Status ShmSink::make_cell_free() {
  refresh_for_sure();
  withdraw(std::min(readers_->taken_by_all(published_), published_ - kCells + kBatch));
  if (published_ - oldest_ < kCells) return {};
  // Half of the ring at once, since to wake is dear.
  auto wanted = published_ - kCells / 2;
  auto room = wait_for_room(wanted, [&] { return readers_->taken_by_all(published_) >= wanted; });
  if (room) withdraw(std::min(readers_->taken_by_all(published_), published_ - kCells + kBatch));
  return room;
}

Status ShmSink::send(const Message& message) {
  refresh();
  if (!begun_) {
    auto came = await_readers(static_cast<std::size_t>(std::max<std::int64_t>(counted_, 1)));
    if (!came) return came;
  }
  begun_ = true;
  if (present_ == 0) {
    if (counted_ > 0 && !stays_) return Error{Code::Closed, "the readers have gone"};
    if (keep_ == 0) {
      if (auto came = await_readers(1); !came) return came;
    } else if (stays_) {
      ++traffic_.messages;
      ++traffic_.cut;
      return {};
    }
  }
  // The header's line and the elements behind it, if they are small, in words.
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
    if (is_too_far_ahead(bytes)) {
      // Half of it at once, since to wake is dear.
      auto wanted = taken_ + 1;
      while (wanted + 1 < published_ &&
             slot_bytes_ + bytes - ahead_[wanted % kCells] > kAheadBytes / 2)
        ++wanted;
      auto room =
          wait_for_room(wanted, [&] { return readers_->taken_by_all(published_) >= wanted; });
      if (!room) return room;
    }
    if (auto placed = place(message, slot); !placed) return placed;
    if (slot == nullptr) {
      ++traffic_.messages;
      ++traffic_.over_memory;
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
  // Who was overtaken and reads this cell now finds `oldest` beyond it afterwards.
  std::atomic_thread_fence(memory_order_release);
  cell.slot.store(slot == nullptr ? 0 : slot->begin, memory_order_relaxed);
  cell.sizes.store(sizes, memory_order_relaxed);
  for (std::size_t i = 0; i < text.size(); ++i) cell.text[i].store(text[i], memory_order_relaxed);
  HC_CRASH_POINT("publisher wrote cell");
  ++published_;
  cell.stamp.store(published_, memory_order_release);
  HC_CRASH_POINT("publisher stamped");
  head_.published.store(published_, memory_order_release);
  head_.signal.store(static_cast<std::uint32_t>(published_), memory_order_release);
  HC_CRASH_POINT("publisher published");
  if (waker_.must_fence()) std::atomic_thread_fence(memory_order_seq_cst);  // wake
  std::atomic_signal_fence(memory_order_seq_cst);
  refresh();
  waker_.wake(*readers_);
  HC_CRASH_POINT("publisher woke readers");
}

Draft ShmSink::loan(const Header& header) {
  auto bytes = header.element_bytes();
  refresh();
  // What will be copied into a cell, behind a header line as most are, needs no slot.
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
  if (!begun_ && counted_ > 0) awaited = await_readers(static_cast<std::size_t>(counted_));
  if (readers_ != nullptr) refresh();  // which tells the log
  end();
  return awaited;
}

/// Readers have the memory for as long as they want; they need nobody to take what is in it.
void ShmSink::end() {
  if (ended_ || readers_ == nullptr) return;
  ended_ = true;
  head_.closed.store(1, memory_order_release);
  HC_CRASH_POINT("publisher closed");
  head_.signal.store(static_cast<std::uint32_t>(published_) + 1, memory_order_release);
  futex_wake(head_.signal);
  readers_.reset();
}

}  // namespace

Status check_shm_memory(const Uri& uri) {
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  if (policy->memory >= kLeastMemory) return {};
  return Error{Code::Usage, "memory is at least " + std::to_string(kLeastMemory) +
                                " bytes where it is shared, not " + std::to_string(policy->memory)};
}

Result<std::unique_ptr<Sink>> open_shm_sink(const Uri& uri, const LinkOptions& options) {
  if (auto named = check_name(uri); !named) return named.error();
  auto counted = number_option(uri, "readers", 0, kMostReaders);
  if (!counted) return counted.error();
  auto stays = number_option(uri, "stay", 0, 1);
  if (!stays) return stays.error();
  if (auto enough = check_shm_memory(uri); !enough) return enough.error();
  auto policy = parse_policy(uri);
  if (!policy) return policy.error();
  auto socket = listen_unix(meeting_place(uri));
  if (!socket) return socket.error();
  auto memory = SharedMemory::make(policy->memory / kPageBytes * kPageBytes, kSlotsBegin);
  if (!memory) return memory.error();
  auto remarks = std::make_shared<Remarks>();
  LinkOptions own = options;
  if (policy->is_paced())  // it sends on the thread that serves links too
    own.log = [remarks](Severity, std::string_view line) { remarks->add(std::string(line)); };
  auto sink = std::make_unique<ShmSink>(std::move(*memory), *counted, *stays == 1,
                                        policy->writer_waits() ? 0 : policy->keep, std::move(own));
  if (auto begun = sink->begin(std::move(*socket)); !begun) return begun.error();
  return make_paced(std::move(sink), *policy, options, std::move(remarks));
}

}  // namespace hc::internal
