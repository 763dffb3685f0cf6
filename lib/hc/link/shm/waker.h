// SPDX-License-Identifier: Apache-2.0
#pragma once
// Wakes sleeping readers of shared memory, and skips the publisher's fence when none has slept
// recently, which moves 1.7 times as many messages of 96 B per second (bench/links, shm_polled,
// between two cores). Internal.

#include <algorithm>
#include <atomic>

#include <hc/link/shm/readers.h>

namespace hc::internal {

/// Decides when a publisher needs a fence before it looks for sleeping readers. While it skips the
/// fence, a reader calls order_everywhere() before it sleeps.
class Waker {
 public:
  explicit Waker(Head& head) : head_(head) {}

  /// To be called when readers have come or left.
  void meet(const std::vector<std::shared_ptr<ShmReader>>& readers) {
    may_leave_fence_ =
        ordering_ && std::all_of(readers.begin(), readers.end(),
                                 [](const auto& each) { return each->hello.orders; });
    fence_again();
  }

  /// Whether a fence is needed between the publication of a message and wake().
  [[nodiscard]] bool must_fence() const { return fencing_; }

  /// Wakes sleeping readers, after a message has been published.
  void wake(ShmReaders& readers) {
    if (readers.wake()) {
      fence_again();
    } else if (fencing_ && may_leave_fence_ && ++undisturbed_ >= kUndisturbed) {
      fencing_ = false;
      head_.unfenced.store(1, std::memory_order_relaxed);
      // A reader that has not seen this yet is seen by the next line.
      std::atomic_thread_fence(std::memory_order_seq_cst);
      if (readers.wake()) fence_again();
    }
  }

 private:
  void fence_again() {
    undisturbed_ = 0;
    if (fencing_) return;
    fencing_ = true;
    std::atomic_thread_fence(std::memory_order_seq_cst);  // for messages published without it
    head_.unfenced.store(0, std::memory_order_release);
  }

  static constexpr int kUndisturbed = 64;  // messages without a sleeper, until it is skipped

  Head& head_;
  const bool ordering_ = allow_ordering();
  bool may_leave_fence_ = false;  // all readers can call order_everywhere()
  bool fencing_ = true;           // not Head::unfenced
  int undisturbed_ = 0;           // messages since a reader slept
};

}  // namespace hc::internal
