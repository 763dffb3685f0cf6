// SPDX-License-Identifier: Apache-2.0
#pragma once
// Allocates slots in a publisher's memory. Internal. Pure: handles offsets only.

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace hc::internal {

/// Room for the elements of one message. It can be reused when nothing in this process refers to it
/// and no reader holds it.
struct Slot {
  std::uint64_t begin = 0, bytes = 0;
  std::uint32_t cells = 0;                 ///< that refer to it
  std::atomic<std::uint32_t> messages{0};  ///< of this process that own it, on any thread

  [[nodiscard]] bool referred_to() const {
    return cells > 0 || messages.load(std::memory_order_acquire) > 0;
  }
};

/// A pool of slots. The one that was returned last is reused first, since it is in the caches.
class SlotPool {
 public:
  /// Slots are in [begin, end), aligned to 64.
  SlotPool(std::uint64_t begin, std::uint64_t end);

  /// A returned slot of `bytes` to twice that; null if there is none. Cost: linear in their number.
  Slot* reuse(std::uint64_t bytes);

  /// A new slot; null if there is no room. Cost: linear in the number of free ranges.
  Slot* allocate(std::uint64_t bytes);

  /// The slot in use that begins at this offset; null if there is none.
  [[nodiscard]] Slot* find(std::uint64_t begin) const;

  /// Returns the slots in use for which `is_free(slot)` is true.
  template <typename IsFree>
  void sweep(const IsFree& is_free) {
    for (auto entry = used_.begin(); entry != used_.end();) {
      if (is_free(*entry->second)) {
        warm_.push_back(std::move(entry->second));
        entry = used_.erase(entry);
      } else {
        ++entry;
      }
    }
  }

 private:
  Slot* use(std::unique_ptr<Slot> slot);
  void merge_warm();

  std::map<std::uint64_t, std::unique_ptr<Slot>> used_;  // by begin
  std::vector<std::unique_ptr<Slot>> warm_;              // returned, in this order
  std::map<std::uint64_t, std::uint64_t> free_;          // begin to end; no two are adjacent
};

}  // namespace hc::internal
