// SPDX-License-Identifier: Apache-2.0
// A reader of `shm:NAME`.
#include <sys/socket.h>

#include <array>
#include <cstring>

#include <hc/link/crash_point.h>
#include <hc/link/shm_greeting.h>
#include <hc/link/stream_link.h>
#include <hc/link/transports.h>
#include <hc/link/unix.h>
#include <hc/wire/framing.h>

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
constexpr std::chrono::milliseconds kSpinLook{1};  // how often one who spins looks at all else

constexpr int kMostSkips = 64;  // until who is overtaken again and again looks after other things

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

Error damaged(const std::string& what) {
  return {Code::Malformed, "shm: the publisher's memory is damaged: " + what};
}

/// A connection to a publisher. Messages that view its memory keep it, also when the source is
/// gone.
struct Attachment {
  Descriptor socket;
  SharedMemory page, memory;

  [[nodiscard]] ReaderPage& own() { return *reinterpret_cast<ReaderPage*>(page.data()); }
  [[nodiscard]] const Head& head() const { return *reinterpret_cast<const Head*>(memory.data()); }
  [[nodiscard]] const Cell& cell(std::uint64_t position) const {
    return reinterpret_cast<const Cell*>(memory.data() + kRingBegin)[position % kCells];
  }

  /// Wakes the publisher if it waits for the room that has been given. A fence stands before.
  void offer_room() {
    auto wanted = head().wanted.load(memory_order_relaxed);
    if (wanted == 0 || own().cursor.load(memory_order_relaxed) < wanted) return;
    own().progress.fetch_add(1, memory_order_release);
    futex_wake(own().progress);
    HC_CRASH_POINT("reader woke publisher");
  }

  void let_go(std::size_t index) {
    own().held[index].store(0, memory_order_release);
    HC_CRASH_POINT("reader let go");
    std::atomic_thread_fence(memory_order_seq_cst);  // room
    offer_room();
  }
};

class ShmSource final : public Source {
 public:
  ShmSource(std::shared_ptr<Attachment> attachment, std::uint64_t begin, std::uint64_t keep,
            std::chrono::microseconds spin, LinkOptions options)
      : attachment_(std::move(attachment)),
        cursor_(begin),
        keep_(keep),
        spin_(spin),
        options_(std::move(options)) {}

  ~ShmSource() override {
    attachment_->own().cursor.store(ReaderPage::kLeft, memory_order_release);
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
  void skip_to(std::uint64_t position);
  bool copy(Copy& cell) const;
  Status deliver(const Copy& cell, Message& message, std::size_t index);
  [[nodiscard]] std::size_t find_free_hold() const;
  void arm(bool on_socket);
  void disarm();

  std::shared_ptr<Attachment> attachment_;
  std::uint64_t cursor_;
  std::uint64_t keep_;
  std::chrono::microseconds spin_;
  LinkOptions options_;
  std::uint32_t arming_ = 0;
  bool armed_ = false;
  bool publisher_gone_ = false;
  bool told_ = false;  // that too many are held
  SmallBytes small_;
  Traffic traffic_;
};

bool ShmSource::is_ready() const {
  return attachment_->cell(cursor_).stamp.load(memory_order_acquire) > cursor_ || has_ended();
}

/// Nothing more comes, and all that came has been taken.
bool ShmSource::has_ended() const {
  return (publisher_gone_ || attachment_->head().closed.load(memory_order_acquire) != 0) &&
         cursor_ >= attachment_->head().published.load(memory_order_acquire);
}

/// Takes the bytes that woke us, and notices when the publisher has gone.
void ShmSource::look_at_socket() {
  std::array<char, 64> bytes;
  ssize_t size = 0;
  while ((size = ::recv(attachment_->socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0) {
  }
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (!publisher_gone_ && attachment_->head().closed.load(memory_order_acquire) == 0 &&
      options_.log)
    options_.log(Severity::Warning, "shm: the publisher has died");
  publisher_gone_ = true;
}

/// Leaves out what was not taken in time.
void ShmSource::skip_to(std::uint64_t position) {
  if (position <= cursor_) return;
  traffic_.superseded += position - cursor_;
  cursor_ = position;
}

/// Copies a cell; false when it is not one.
bool ShmSource::copy(Copy& cell) const {
  const Cell& shared = attachment_->cell(cursor_);
  cell.slot = shared.slot.load(memory_order_relaxed);
  auto sizes = shared.sizes.load(memory_order_relaxed);
  cell.header_bytes = sizes & 0xffff;
  cell.bytes = sizes >> 16;
  auto bytes = cell.header_bytes + (cell.slot == 0 ? cell.bytes : 0);
  if (bytes > Cell::kTextBytes) return false;
  for (std::size_t i = 0; i * sizeof(std::uint64_t) < bytes; ++i)
    cell.words[i] = shared.text[i].load(memory_order_relaxed);
  return true;
}

std::size_t ShmSource::find_free_hold() const {
  const auto& held = attachment_->own().held;
  std::size_t index = 0;
  // The last one is for a message that is copied.
  while (index < kMostHeld - 1 && held[index].load(memory_order_acquire) != 0) ++index;
  return index;
}

/// Makes a message of a cell, of which a slot is held already.
Status ShmSource::deliver(const Copy& cell, Message& message, std::size_t index) {
  auto line = read_header_line({cell.text(), cell.header_bytes}, options_.limits, traffic_.bytes);
  if (!line) return line.error();
  if (line->bytes != cell.header_bytes) return damaged("a header without its end");
  const Header& header = line->header;
  bool right = is_compressed(header) ? cell.bytes <= options_.limits.element_bytes
                                     : cell.bytes == header.element_bytes();
  if (!right) return damaged(std::to_string(cell.bytes) + " bytes of elements for " + text(header));
  message.header = header;
  message.byte = traffic_.bytes;
  if (cell.slot == 0) {
    auto room = small_.allocate(cell.bytes);
    std::memcpy(room.get(), cell.text() + cell.header_bytes, cell.bytes);
    message.elements = {room.get(), cell.bytes};
    message.owner = std::move(room);
    return {};
  }
  const std::byte* from = attachment_->memory.data() + cell.slot;
  if (index < kMostHeld - 1) {
    message.elements = {from, cell.bytes};
    message.owner = std::shared_ptr<const void>(
        from, [attachment = attachment_, index](const void*) { attachment->let_go(index); });
    return {};
  }
  if (!told_ && options_.log)
    options_.log(Severity::Warning,
                 "shm: " + std::to_string(kMostHeld - 1) +
                     " messages are held; as long as it is so, others are copied");
  told_ = true;
  message.elements = {from, cell.bytes};
  message.owner = nullptr;
  message = message.keep();
  attachment_->let_go(index);
  return {};
}

Result<Got> ShmSource::take(Message& message) {
  message.owner.reset();
  message.elements = {};
  const Head& head = attachment_->head();
  ReaderPage& own = attachment_->own();
  for (int tries = 0; tries < kMostSkips; ++tries) {
    if (keep_ > 0) {
      auto published = head.published.load(memory_order_acquire);
      if (published - cursor_ > keep_ && published > cursor_) skip_to(published - keep_);
    }
    auto stamp = attachment_->cell(cursor_).stamp.load(memory_order_acquire);
    if (stamp <= cursor_) {
      own.cursor.store(cursor_, memory_order_release);
      return has_ended() ? Got::End : Got::Nothing;
    }
    if (stamp == cursor_ + 1) {
      Copy cell;
      bool whole = copy(cell);
      std::size_t index = kMostHeld;
      bool valid_slot = true;
      if (whole && cell.slot != 0) {
        const auto memory = attachment_->memory.size();
        valid_slot = cell.slot >= kSlotsBegin && cell.slot % kLine == 0 && cell.slot < memory &&
                     cell.bytes <= memory - cell.slot;
        index = find_free_hold();
        own.held[index].store(cell.slot, memory_order_relaxed);
      }
      own.cursor.store(cursor_ + 1, memory_order_release);
      HC_CRASH_POINT("reader holds");
      bool look = cell.slot != 0 || cursor_ % kLookEvery == 0;
      std::atomic_thread_fence(look ? memory_order_seq_cst : memory_order_acquire);  // hold, room
      if (head.oldest.load(memory_order_acquire) <= cursor_) {
        HC_CRASH_POINT("reader validated");
        ++cursor_;
        if (look) attachment_->offer_room();
        Status delivered = damaged("the sizes of a cell");
        if (whole && valid_slot) delivered = deliver(cell, message, index);
        if (!delivered) {
          if (index < kMostHeld) attachment_->let_go(index);
          return delivered.error();
        }
        ++traffic_.messages;
        traffic_.bytes += cell.bytes;
        if (armed_) disarm();
        HC_CRASH_POINT("reader delivers");
        return Got::Message;
      }
      if (index < kMostHeld) attachment_->let_go(index);
    }
    // Overtaken: this cell has been withdrawn.
    auto oldest = head.oldest.load(memory_order_acquire);
    if (oldest <= cursor_) return damaged("the stamp of a cell");
    skip_to(oldest);
  }
  return Got::Nothing;  // the publisher is faster; wait() comes back at once
}

void ShmSource::arm(bool on_socket) {
  arming_ += 2;
  std::uint32_t value = (arming_ == 0 ? arming_ = 2 : arming_) | (on_socket ? 1 : 0);
  attachment_->own().armed.store(value, memory_order_relaxed);
  armed_ = true;
  HC_CRASH_POINT("reader armed");
  std::atomic_thread_fence(memory_order_seq_cst);  // wake
}

void ShmSource::disarm() {
  attachment_->own().armed.store(0, memory_order_relaxed);
  armed_ = false;
}

bool ShmSource::prepare_wait() {
  look_at_socket();
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
    for (int i = 0; i < 64; ++i) {
      if (is_ready()) return true;
      relax();
    }
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

}  // namespace

Result<std::unique_ptr<Source>> open_shm_source(const Uri& uri, const LinkOptions& options) {
  auto wait = number_option(uri, "wait", 0);
  if (!wait) return wait.error();
  auto spin = number_option(uri, "spin", 0);
  if (!spin) return spin.error();
  auto keep = uri.option("keep", "");
  if (!keep.empty())
    if (auto valid = parse_keep(keep); !valid) return valid.error();
  Uri place = meeting_place(uri);
  place.options.emplace_back("wait", std::to_string(*wait));
  auto socket = connect_unix(place, options);
  if (!socket) return socket.error();
  auto attachment = std::make_shared<Attachment>();
  attachment->socket = std::move(*socket);
  auto page = SharedMemory::make(kPageBytes, kPageBytes);
  if (!page) return page.error();
  attachment->page = std::move(*page);
  HC_CRASH_POINT("reader made page");
  auto offer = greet(attachment->socket.get(), keep, attachment->page, options.stop);
  if (!offer) return offer.error();
  attachment->memory = std::move(offer->memory);
  auto begin = offer->begin;
  attachment->own().cursor.store(begin, memory_order_release);
  return std::unique_ptr<Source>(std::make_unique<ShmSource>(
      std::move(attachment), begin, offer->keep, std::chrono::microseconds(*spin), options));
}

}  // namespace hc::internal
