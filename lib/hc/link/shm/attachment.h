// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a reader of shared memory has of its publisher: the connection, and the memory of both.
// Internal.

#include <cstddef>
#include <cstdint>

#include <hc/link/shm/crash_point.h>
#include <hc/link/shm/layout.h>
#include <hc/os/descriptor.h>

namespace hc::internal {

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

  /// Wakes the publisher if it waits for what this reader has just taken. A fence stands before.
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

}  // namespace hc::internal
