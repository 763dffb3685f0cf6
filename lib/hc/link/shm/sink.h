// SPDX-License-Identifier: Apache-2.0
#pragma once
// The publisher of `shm:NAME`: sink.cpp publishes messages, sink_room.cpp finds room for them. Not
// thread-safe. Internal.

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <utility>

#include <hc/link/audience.h>
#include <hc/link/link.h>
#include <hc/link/shm/readers.h>
#include <hc/link/shm/slots.h>
#include <hc/link/shm/waker.h>
#include <hc/mtp/header_memo.h>

namespace hc::internal {

class ShmSink final : public Sink {
 public:
  ShmSink(SharedMemory memory, Audience audience, const Policy& policy, LinkOptions options)
      : memory_(std::make_shared<SharedMemory>(std::move(memory))),
        head_(*reinterpret_cast<Head*>(memory_->data())),
        cells_(reinterpret_cast<Cell*>(memory_->data() + kRingBegin)),
        slots_(std::make_shared<SlotPool>(kSlotsBegin, memory_->size())),
        audience_(std::move(audience)),
        keep_(policy.writer_waits() ? 0 : policy.keep),
        timeout_(policy.timeout),
        options_(std::move(options)) {}
  ~ShmSink() override { end(); }

  /// Starts to accept readers; to be called first. Errors: System.
  Status begin(ListeningSocket socket) {
    readers_ = HC_TRY(ShmReaders::make(std::move(socket), *memory_, keep_,
                                       Patience(timeout_, options_.awaits_reader, options_.log)));
    return {};
  }

  Status send(const Message& message) override;
  Draft loan(const Header& header) override;
  Status close() override;
  void abandon() override { end(); }
  [[nodiscard]] Traffic traffic() const override { return traffic_; }
  std::optional<std::size_t> peers() override {
    refresh();
    return present_;
  }

 private:
  void publish(std::span<const std::uint64_t> text, std::uint64_t sizes, Slot* slot);
  void end();

  // Readers (sink_room.cpp).
  /// Updates the readers. Cost: one load if none has come or left.
  void refresh() {
    if (readers_->changed()) meet_readers();
  }
  void meet_readers();
  void refresh_for_sure();
  Status await_readers();
  static Error abandoned() { return {Code::Closed, "the link was abandoned"}; }

  // Room for messages (sink_room.cpp).
  [[nodiscard]] bool is_too_far_ahead(std::uint64_t bytes);
  Status let_catch_up(std::uint64_t bytes);
  Status wait_for_room(std::uint64_t wanted, const std::function<bool()>& has_room);
  Status make_cell_free();
  Status place(const Message& message, Slot*& slot);
  Slot* take_slot(std::uint64_t bytes);
  Slot* clear_slot(std::uint64_t bytes);
  Slot* reserve(Slot* slot);
  void withdraw(std::uint64_t end);
  void sweep();

  // Shared with messages of this process, which may outlive the sink.
  std::shared_ptr<SharedMemory> memory_;
  Head& head_;
  Cell* cells_;
  std::shared_ptr<SlotPool> slots_;
  std::unique_ptr<ShmReaders> readers_;
  Audience audience_;
  std::uint64_t keep_;  // of the newest messages, unless a reader requests fewer; 0: all
  std::chrono::seconds timeout_;
  LinkOptions options_;

  std::uint64_t published_ = 0, oldest_ = 0;  // as in head_
  std::array<Slot*, kCells> slot_of_cell_{};
  std::array<std::uint64_t, kCells> ahead_{};  // bytes sent in slots before the message of a cell
  std::uint64_t slot_bytes_ = 0;               // bytes sent in slots so far
  std::uint64_t taken_ = 0;                    // the last result of taken_by_all()
  HeaderMemo memo_;
  Waker waker_{head_};
  std::size_t present_ = 0;  // readers that take messages
  bool ended_ = false;
  Status host_;  // an error if the host had no memory for the last slot
  Traffic traffic_;
};

}  // namespace hc::internal
