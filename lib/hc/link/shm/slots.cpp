// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/slots.h>

#include <algorithm>
#include <iterator>

#include <hc/link/shm/layout.h>

namespace hc::internal {
namespace {

std::uint64_t in_lines(std::uint64_t bytes) {
  return std::max<std::uint64_t>((bytes + kLine - 1) / kLine, 1) * kLine;
}

}  // namespace

SlotPool::SlotPool(std::uint64_t begin, std::uint64_t end) {
  free_.emplace(begin, end);
}

Slot* SlotPool::reuse(std::uint64_t bytes) {
  bytes = in_lines(bytes);
  // A slot more than twice as large is left to the messages for which it was made.
  auto fits = [&](const auto& slot) { return slot->bytes >= bytes && slot->bytes / 2 <= bytes; };
  auto last = std::find_if(warm_.rbegin(), warm_.rend(), fits);
  if (last == warm_.rend()) return nullptr;
  auto slot = std::move(*last);
  warm_.erase(std::next(last).base());
  return use(std::move(slot));
}

Slot* SlotPool::allocate(std::uint64_t bytes) {
  bytes = in_lines(bytes);
  auto find_range = [&] {
    return std::find_if(free_.begin(), free_.end(),
                        [&](const auto& entry) { return entry.second - entry.first >= bytes; });
  };
  auto range = find_range();
  if (range == free_.end()) {
    merge_warm();
    range = find_range();
  }
  if (range == free_.end()) return nullptr;
  auto [begin, end] = *range;
  free_.erase(range);
  if (begin + bytes < end) free_.emplace(begin + bytes, end);
  auto slot = std::make_unique<Slot>();
  slot->begin = begin;
  slot->bytes = bytes;
  return use(std::move(slot));
}

Slot* SlotPool::find(std::uint64_t begin) const {
  auto found = used_.find(begin);
  return found == used_.end() ? nullptr : found->second.get();
}

Slot* SlotPool::use(std::unique_ptr<Slot> slot) {
  auto begin = slot->begin;
  return (used_[begin] = std::move(slot)).get();
}

/// Turns the returned slots into free ranges, and merges adjacent ones.
void SlotPool::merge_warm() {
  for (const auto& slot : warm_) free_.emplace(slot->begin, slot->begin + slot->bytes);
  warm_.clear();
  for (auto range = free_.begin(); range != free_.end();) {
    auto next = std::next(range);
    if (next != free_.end() && next->first == range->second) {
      range->second = next->second;
      free_.erase(next);
    } else {
      range = next;
    }
  }
}

}  // namespace hc::internal
