// SPDX-License-Identifier: Apache-2.0
// A reader of `shm:NAME`.
#include <sched.h>
#include <sys/socket.h>

#include <array>
#include <cstring>

#include <hc/link/awaiting_source.h>
#include <hc/link/dialing.h>
#include <hc/link/shm/attachment.h>
#include <hc/link/shm/crash_point.h>
#include <hc/link/shm/greeting.h>
#include <hc/link/stream_link.h>
#include <hc/link/transports.h>
#include <hc/link/unix.h>
#include <hc/wire/framing.h>
#include <hc/wire/header_memo.h>

#if defined(__x86_64__) || defined(__i386__)
#include <emmintrin.h>
#endif

namespace hc::internal {
namespace {

using std::memory_order_acquire;
using std::memory_order_relaxed;
using std::memory_order_release;
using std::memory_order_seq_cst;
using Clock = std::chrono::steady_clock;

/// How often a reader that gets through looks whether it is waited for; see Head::wanted.
constexpr std::uint64_t kLookEvery = 64;  // messages
/// How long one sleeps on the futex, which is quick to wake but hears of nothing else, before one
/// waits on the socket.
constexpr std::chrono::milliseconds kFutexTime{100};
/// About as long as it takes to sleep and wake: who spins so long never loses more than that.
constexpr std::int64_t kDefaultSpin = 20;           // [µs]
constexpr std::chrono::microseconds kSpinAlone{2};  // until one who spins lets others run
constexpr int kSpinRounds = 32;                     // between two looks at the clock
constexpr std::chrono::milliseconds kSpinLook{1};   // how often one who spins looks at all else

constexpr unsigned kLookSeldom = 8;  // waits, until one looks at a silent link

constexpr std::size_t kCopyHold = kMostHeld - 1;
constexpr std::size_t kNoHold = kMostHeld;
constexpr int kMostSkips = 64;  // until who is overtaken again and again looks after other things

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

Error damaged(const std::string& what) {
  return {Code::Malformed, "the publisher's memory is damaged: " + what};
}

class ShmSource final : public Source {
 public:
  ShmSource(std::shared_ptr<Attachment> attachment, const Offer& offer,
            std::chrono::microseconds spin, LinkOptions options)
      : attachment_(std::move(attachment)),
        cursor_(offer.begin),
        keep_(offer.keep),
        spin_(spin),
        options_(std::move(options)) {}

  ~ShmSource() override {
    attachment_->own().cursor.store(ReaderPage::kLeft, memory_order_release);
    HC_CRASH_POINT("reader left");
    ::shutdown(attachment_->socket.get(), SHUT_WR);
  }

  Result<Got> take(Message& message) override;
  [[nodiscard]] int descriptor() const override { return attachment_->socket.get(); }
  bool prepare_wait() override;
  Result<bool> wait(int stop, std::chrono::milliseconds timeout) override;
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  struct Copy {
    std::array<std::uint64_t, Cell::kWords> words;
    std::uint64_t slot, bytes;  // of the elements
    std::size_t header_bytes;
    [[nodiscard]] const char* text() const { return reinterpret_cast<const char*>(words.data()); }
  };

  [[nodiscard]] bool is_ready() const;
  [[nodiscard]] bool has_ended() const;
  void look_at_socket();
  void skip_to(std::uint64_t position, std::uint64_t Traffic::*why);
  void skip_withdrawn(std::uint64_t oldest);
  bool copy(Copy& cell) const;
  Status deliver(const Copy& cell, Message& message, std::size_t hold);
  std::size_t take_hold(std::uint64_t slot);
  void fetch_ahead();
  [[nodiscard]] bool is_withdrawn() const;
  void finish_cell(bool has_slot);
  void arm(bool on_socket);
  void disarm();

  std::shared_ptr<Attachment> attachment_;
  std::uint64_t cursor_;
  std::uint64_t keep_;
  std::uint64_t known_ = 0;  // positions below are known to be published
  std::chrono::microseconds spin_;
  LinkOptions options_;
  std::uint32_t arming_ = 0;
  bool armed_ = false;
  unsigned unlooked_ = 0;  // waits that began without a look at the socket
  bool publisher_gone_ = false;
  bool told_ = false;  // that too many are held
  HeaderMemo memo_;
  Traffic traffic_;
};

bool ShmSource::is_ready() const {
  return attachment_->cell(cursor_).stamp.load(memory_order_acquire) > cursor_ || has_ended();
}

/// Nothing comes where there was nothing a moment ago: the publisher has gone, or has closed and
/// all that it published has been taken.
bool ShmSource::has_ended() const {
  const Head& head = attachment_->head();
  return publisher_gone_ || (head.closed.load(memory_order_acquire) != 0 &&
                             cursor_ >= head.published.load(memory_order_acquire));
}

/// Takes the bytes that woke us, and notices when the publisher has gone.
void ShmSource::look_at_socket() {
  std::array<char, 64> bytes;
  const auto most = static_cast<ssize_t>(bytes.size());
  ssize_t size = most;
  while (size == most)
    size = ::recv(attachment_->socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  // Behind a short read there is nothing but, perhaps, the end: poll() tells of that again.
  if (size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR))) return;
  publisher_gone_ = true;
}

/// Leaves out what was not taken in time.
void ShmSource::skip_to(std::uint64_t position, std::uint64_t Traffic::*why) {
  if (position <= cursor_) return;
  traffic_.*why += position - cursor_;
  cursor_ = position;
}

/// The same of what the publisher has taken back. What this reader wanted to keep is lost because
/// there was no memory for it, or no cell.
void ShmSource::skip_withdrawn(std::uint64_t oldest) {
  auto published = attachment_->head().published.load(memory_order_acquire);
  if (published > keep_) skip_to(std::min(oldest, published - keep_), &Traffic::superseded);
  skip_to(oldest, &Traffic::over_memory);
}

/// Copies a cell; false when it is not one, or when another was just being written over it.
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

/// Holds a slot; the last of the holds, which is for messages that are copied, when all are taken.
std::size_t ShmSource::take_hold(std::uint64_t slot) {
  auto& held = attachment_->own().held;
  std::size_t index = 0;
  while (index < kCopyHold && held[index].load(memory_order_acquire) != 0) ++index;
  held[index].store(slot, memory_order_relaxed);
  return index;
}

/// Makes a message of a cell that was copied, whose slot is held.
Status ShmSource::deliver(const Copy& cell, Message& message, std::size_t hold) {
  std::string_view line(cell.text(), cell.header_bytes);
  if (!line.ends_with('\n')) return damaged("a header without its end");
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
    return damaged("the place of a slot");
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
    message.owner = std::shared_ptr<const void>(
        from, [attachment = attachment_, hold](const void*) { attachment->let_go(hold); });
    return {};
  }
  if (!told_ && options_.log)
    options_.log(Severity::Warning, std::to_string(kCopyHold) +
                                        " messages are held; while it is so, others are copied");
  told_ = true;
  message = message.keep();
  attachment_->let_go(hold);
  return {};
}

Result<Got> ShmSource::take(Message& message) {
  message.owner.reset();
  message.elements = {};
  const Head& head = attachment_->head();
  for (int tries = 0; tries < kMostSkips; ++tries) {
    if (keep_ > 0) {
      auto published = head.published.load(memory_order_acquire);
      if (published > cursor_ && published - cursor_ > keep_)
        skip_to(published - keep_, &Traffic::superseded);
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
      // Who loses nothing is waited for; others have to see that they were not overtaken meanwhile.
      if (keep_ == 0 || !is_withdrawn()) {
        finish_cell(cell.slot != 0);
        auto delivered = fits ? deliver(cell, message, hold) : damaged("the sizes of a cell");
        if (!delivered) {
          if (hold != kNoHold) attachment_->let_go(hold);
          return delivered.error();
        }
        return Got::Message;
      }
      if (hold != kNoHold) attachment_->let_go(hold);
    }
    auto oldest = head.oldest.load(memory_order_acquire);
    if (oldest <= cursor_) return damaged("the stamp of a cell");
    skip_withdrawn(oldest);
  }
  return Got::Nothing;  // the publisher is faster; wait() comes back at once
}

/// Has the cells that are to come brought here, of those that are there.
void ShmSource::fetch_ahead() {
  if (cursor_ >= known_ && cursor_ % kFetchAhead == 0)
    known_ = attachment_->head().published.load(memory_order_relaxed);
  if (cursor_ + kFetchAhead >= known_) return;
  const Cell& later = attachment_->cell(cursor_ + kFetchAhead);
  for (std::size_t line = 0; line < kFetchBytes; line += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&later) + line);
}

bool ShmSource::is_withdrawn() const {
  std::atomic_thread_fence(memory_order_seq_cst);  // hold
  return attachment_->head().oldest.load(memory_order_acquire) > cursor_;
}

/// Says that the cell has been taken. Whoever reads that also reads what is held by then.
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

void ShmSource::arm(bool on_socket) {
  arming_ += 2;
  std::uint32_t value = (arming_ == 0 ? arming_ = 2 : arming_) | (on_socket ? 1 : 0);
  attachment_->own().armed.store(value, memory_order_relaxed);
  armed_ = true;
  HC_CRASH_POINT("reader armed");
  std::atomic_thread_fence(memory_order_seq_cst);  // wake
  if (attachment_->head().unfenced.load(memory_order_acquire) != 0) order_everywhere();
}

void ShmSource::disarm() {
  attachment_->own().armed.store(0, memory_order_relaxed);
  armed_ = false;
}

bool ShmSource::prepare_wait() {
  // Who is armed still was woken by another link: nothing but the end can have come meanwhile.
  if (!armed_ || ++unlooked_ % kLookSeldom == 0) look_at_socket();
  arm(true);
  if (!is_ready()) return true;
  disarm();
  return false;
}

Result<bool> ShmSource::wait(int stop, std::chrono::milliseconds timeout) {
  const auto begin = Clock::now();
  auto passed = [&] { return Clock::now() - begin; };
  auto is_over = [&] { return timeout.count() >= 0 && passed() >= timeout; };
  auto look = [&]() -> Status {
    look_at_socket();
    auto stopped = wait_readable({}, stop, std::chrono::milliseconds(0));
    return stopped ? Status() : stopped.error();
  };
  for (auto next_look = begin + kSpinLook; passed() < spin_;) {
    for (int i = 0; i < kSpinRounds; ++i) {
      if (is_ready()) return true;
      relax();
    }
    if (passed() > kSpinAlone) ::sched_yield();
    if (is_over()) return false;
    if (Clock::now() < next_look) continue;
    if (auto looked = look(); !looked) return looked.error();
    next_look = Clock::now() + kSpinLook;
  }
  const auto slept_from = Clock::now();
  while (true) {
    auto signal = attachment_->head().signal.load(memory_order_acquire);
    arm(false);
    if (is_ready()) {
      disarm();
      return true;
    }
    if (is_over()) {
      disarm();
      return false;
    }
    auto left = kFutexTime - (Clock::now() - slept_from);
    if (left <= Clock::duration(0) || publisher_gone_) break;
    if (timeout.count() >= 0) left = std::min<Clock::duration>(left, timeout - passed());
    futex_wait(attachment_->head().signal, signal, left);
    if (is_ready()) continue;
    if (auto looked = look(); !looked) return looked.error();
  }
  if (!prepare_wait()) return true;
  auto left = std::chrono::milliseconds(-1);
  if (timeout.count() >= 0)
    left = std::max(std::chrono::ceil<std::chrono::milliseconds>(timeout - passed()),
                    std::chrono::milliseconds(0));
  std::array<int, 1> descriptors = {descriptor()};
  auto ready = wait_readable(descriptors, stop, left);
  if (!ready) return ready.error();
  return *ready == 0;
}

/// How a reader attaches.
struct Wishes {
  std::string keep;  ///< empty: as the publisher wants it
  std::chrono::microseconds spin;
  bool waits;  ///< for the publisher's answer, or else take() does without
};

/// Makes the reader of a publisher that has been connected to. Errors: as await_offer().
Result<std::unique_ptr<Source>> attach(Descriptor socket, const Wishes& wishes,
                                       const LinkOptions& options) {
  auto attachment = std::make_shared<Attachment>();
  attachment->socket = std::move(socket);
  auto page = SharedMemory::make(kPageBytes, kPageBytes);
  if (!page) return page.error();
  attachment->page = std::move(*page);
  HC_CRASH_POINT("reader made page");
  const int connection = attachment->socket.get();
  if (auto sent = send_hello(connection, wishes.keep, attachment->page); !sent) return sent.error();
  auto begin = [attachment, spin = wishes.spin, options](Offer offer) -> std::unique_ptr<Source> {
    attachment->memory = std::move(offer.memory);
    attachment->own().cursor.store(offer.begin, memory_order_release);
    return std::make_unique<ShmSource>(attachment, offer, spin, options);
  };
  if (!wishes.waits)
    return std::unique_ptr<Source>(std::make_unique<AwaitingSource>(
        connection, [connection, begin]() -> Result<std::unique_ptr<Source>> {
          auto offer = take_offer(connection);
          if (!offer) return offer.error();
          return offer->has_value() ? begin(std::move(**offer)) : nullptr;
        }));
  auto offer = await_offer(connection, options.stop);
  if (!offer) return offer.error();
  return begin(std::move(*offer));
}

}  // namespace

Result<std::unique_ptr<Source>> open_shm_source(const Uri& uri, const LinkOptions& options) {
  if (auto named = check_name(uri); !named) return named.error();
  auto spin = number_option(uri, "spin", kDefaultSpin);
  if (!spin) return spin.error();
  auto reconnect = number_option(uri, "reconnect", 0);
  if (!reconnect) return reconnect.error();
  Wishes wishes{std::string(uri.option("keep", "")), std::chrono::microseconds(*spin),
                *reconnect == 0};
  if (!wishes.keep.empty())
    if (auto valid = parse_keep(wishes.keep); !valid) return valid.error();
  Uri place = meeting_place(uri);
  auto peer = unix_peer(place);
  if (!peer) return peer.error();
  peer->name = uri.rest;
  return dial_source(*peer, uri, options, [wishes, options](Descriptor socket) {
    return attach(std::move(socket), wishes, options);
  });
}

}  // namespace hc::internal
