// SPDX-License-Identifier: Apache-2.0
#pragma once
// The reader of `shm:NAME`: takes messages from the publisher's memory, which may be overwritten at
// any time. Internal.

#include <array>
#include <chrono>
#include <memory>

#include <hc/link/link.h>
#include <hc/link/shm/crash_point.h>
#include <hc/link/shm/greeting.h>
#include <hc/mtp/header_memo.h>

namespace hc::internal {

/// A connection to a publisher. Messages that view its memory share it, and may outlive the source.
struct Attachment {
  Descriptor socket;
  SharedMemory page, memory;

  [[nodiscard]] ReaderPage& own() { return *reinterpret_cast<ReaderPage*>(page.data()); }
  [[nodiscard]] const Head& head() const { return *reinterpret_cast<const Head*>(memory.data()); }
  [[nodiscard]] const Cell& cell(std::uint64_t position) const {
    return reinterpret_cast<const Cell*>(memory.data() + kRingBegin)[position % kCells];
  }

  /// Wakes the publisher if it waits for this cursor. The caller has put a fence before.
  void offer_cells() {
    auto wanted = head().wanted.load(std::memory_order_relaxed);
    if (wanted != 0 && own().cursor.load(std::memory_order_relaxed) >= wanted) wake_publisher();
  }

  void let_go(std::size_t index) {
    own().held[index].store(0, std::memory_order_release);
    HC_CRASH_POINT("reader let go");
    std::atomic_thread_fence(std::memory_order_seq_cst);  // room
    if (head().wanted.load(std::memory_order_relaxed) == Head::kAnyRoom) wake_publisher();
  }

 private:
  void wake_publisher() {
    own().progress.fetch_add(1, std::memory_order_release);
    futex_wake(own().progress);
    HC_CRASH_POINT("reader woke publisher");
  }
};

/// The pipe through which publishers wake a reader, for all connections of a link. Errors: System.
Result<std::shared_ptr<const Descriptor>> make_wake_pipe();

class ShmSource final : public Source {
 public:
  /// The reader has sent its request; the publisher may not have answered yet.
  ShmSource(std::shared_ptr<Attachment> attachment, std::shared_ptr<const Descriptor> wakes,
            std::chrono::microseconds spin, LinkOptions options)
      : attachment_(std::move(attachment)),
        wakes_(std::move(wakes)),
        spin_(spin),
        options_(std::move(options)) {}
  /// Sets the publisher's answer.
  void attach(Offer offer);

  ~ShmSource() override;

  Result<Got> take(Message& message) override;
  [[nodiscard]] int descriptor() const override { return attachment_->socket.get(); }
  [[nodiscard]] int wake_descriptor() const override { return wakes_->get(); }
  bool prepare_wait() override;
  [[nodiscard]] Spin spin() const override;
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

 private:
  struct Copy {
    std::array<std::uint64_t, Cell::kWords> words;
    std::uint64_t slot, bytes;  // of the elements
    std::size_t header_bytes;
    [[nodiscard]] const char* text() const { return reinterpret_cast<const char*>(words.data()); }
  };

  /// Given that there was no message before this call: whether the publisher is gone, or has closed
  /// and everything published has been taken.
  [[nodiscard]] bool has_ended() const {
    const Head& head = attachment_->head();
    return publisher_gone_ || (head.closed.load(std::memory_order_acquire) != 0 &&
                               cursor_ >= head.published.load(std::memory_order_acquire));
  }
  void skip_to(std::uint64_t position, std::uint64_t Traffic::*why);
  void skip_withdrawn(std::uint64_t oldest);
  bool copy(Copy& cell) const;
  Status deliver(const Copy& cell, Message& message, std::size_t hold);
  std::size_t take_hold(std::uint64_t slot);
  void fetch_ahead();
  [[nodiscard]] bool is_withdrawn(bool holds) const;
  void finish_cell(bool has_slot);

  [[nodiscard]] bool attached() const { return attachment_->memory.data() != nullptr; }
  [[nodiscard]] bool is_ready() const;
  void look_at_socket();
  void drain_pipe() const;
  void disarm() {
    attachment_->own().armed.store(0, std::memory_order_relaxed);
    armed_ = false;
  }

  std::shared_ptr<Attachment> attachment_;
  std::shared_ptr<const Descriptor> wakes_;
  std::uint64_t cursor_ = 0;
  std::uint64_t keep_ = 0;
  std::uint64_t known_ = 0;  // the last value of `published` seen
  std::chrono::microseconds spin_;
  LinkOptions options_;
  std::uint32_t arming_ = 0;
  bool armed_ = false;
  unsigned vain_waits_ = 0;
  bool publisher_gone_ = false;
  bool told_ = false;  // it has been logged that too many messages are held
  HeaderMemo memo_;
  Traffic traffic_;
};

}  // namespace hc::internal
