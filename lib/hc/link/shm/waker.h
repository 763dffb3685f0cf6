// SPDX-License-Identifier: Apache-2.0
#pragma once
// Wakes the readers of shared memory that sleep, and leaves out the publisher's fence when nobody
// has slept for a while: then 1.7 times as many messages of 96 B a second go through (bench/links,
// shm_polled, between two cores). Internal.

#include <algorithm>
#include <atomic>

#include <hc/link/shm/readers.h>

namespace hc::internal {

/// What a publisher knows of the sleep of its readers. Who goes to sleep while the fence is left
/// out orders the stores of both sides (order_everywhere()).
class Waker {
 public:
  explicit Waker(Head& head) : head_(head) {}

  /// To be called when readers came or went.
  void meet(const std::vector<std::shared_ptr<ShmReader>>& readers) {
    may_leave_fence_ =
        ordering_ && std::all_of(readers.begin(), readers.end(),
                                 [](const auto& each) { return each->hello.orders; });
    fence_again();
  }

  /// Whether a fence is needed between a message's publication and wake().
  [[nodiscard]] bool must_fence() const { return fencing_; }

  /// Wakes those who sleep, after a message has been published.
  void wake(ShmReaders& readers) {
    if (readers.wake()) {
      fence_again();
    } else if (fencing_ && may_leave_fence_ && ++undisturbed_ >= kUndisturbed) {
      fencing_ = false;
      head_.unfenced.store(1, std::memory_order_relaxed);
      // Who has not seen that yet is seen here.
      std::atomic_thread_fence(std::memory_order_seq_cst);
      if (readers.wake()) fence_again();
    }
  }

 private:
  void fence_again() {
    undisturbed_ = 0;
    if (fencing_) return;
    fencing_ = true;
    std::atomic_thread_fence(std::memory_order_seq_cst);  // of what was published without one
    head_.unfenced.store(0, std::memory_order_release);
  }

  static constexpr int kUndisturbed = 64;  // messages while nobody slept, until it is skipped

  Head& head_;
  const bool ordering_ = allow_ordering();
  bool may_leave_fence_ = false;  // all readers can order the stores of both sides
  bool fencing_ = true;           // not Head::unfenced
  int undisturbed_ = 0;           // messages published since a reader slept
};

}  // namespace hc::internal
