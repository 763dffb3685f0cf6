// SPDX-License-Identifier: Apache-2.0
#pragma once
// A reader of `shm:NAME`: source.cpp takes messages, source_wait.cpp waits for them. Internal.

#include <array>
#include <chrono>
#include <memory>

#include <hc/link/shm/attachment.h>
#include <hc/link/shm/greeting.h>
#include <hc/link/transports.h>
#include <hc/mtp/header_memo.h>

namespace hc::internal {

class ShmSource final : public Source {
 public:
  ShmSource(std::shared_ptr<Attachment> attachment, const Offer& offer,
            std::chrono::microseconds spin, LinkOptions options)
      : attachment_(std::move(attachment)),
        cursor_(offer.begin),
        keep_(offer.keep),
        spin_(spin),
        options_(std::move(options)) {}

  ~ShmSource() override;

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

  // Taking (source.cpp).
  /// Nothing comes where there was nothing a moment ago: the publisher has gone, or has closed and
  /// all that it published has been taken.
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
  [[nodiscard]] bool is_withdrawn() const;
  void finish_cell(bool has_slot);

  // Waiting (source_wait.cpp).
  [[nodiscard]] bool is_ready() const;
  void look_at_socket();
  void arm(bool on_socket);
  void disarm() {
    attachment_->own().armed.store(0, std::memory_order_relaxed);
    armed_ = false;
  }

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

}  // namespace hc::internal
