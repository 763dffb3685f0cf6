// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which bytes of a publisher's memory are in use. Internal. Pure: knows offsets alone.

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace hc::internal {

/// Room for the elements of one message. It may be used again when nobody refers to it here and no
/// reader holds it.
struct Slot {
  std::uint64_t begin = 0, bytes = 0;
  std::uint32_t cells = 0;                 ///< of the ring, that refer to it
  std::atomic<std::uint32_t> messages{0};  ///< of this process, on any thread, that own it

  [[nodiscard]] bool referred_to() const {
    return cells > 0 || messages.load(std::memory_order_acquire) > 0;
  }
};

/// Gives out slots: the one that was given back last first, since it is in the caches still.
class SlotPool {
 public:
  /// Slots stand in [begin, end), aligned to 64.
  SlotPool(std::uint64_t begin, std::uint64_t end);

  /// One of at least `bytes` that was given back; null when there is none of about that size.
  /// Cost: a look at the slots given back.
  Slot* reuse(std::uint64_t bytes);

  /// A new one where no slot is; null when there is no room. Cost: a look at the free ranges.
  Slot* allocate(std::uint64_t bytes);

  /// The slot in use that begins there; null: none does.
  [[nodiscard]] Slot* find(std::uint64_t begin) const;

  /// Takes back each slot in use of which `is_free(slot)` is true.
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
  std::vector<std::unique_ptr<Slot>> warm_;              // given back, the last one last
  std::map<std::uint64_t, std::uint64_t> free_;          // begin to end; no two touch
};

}  // namespace hc::internal
