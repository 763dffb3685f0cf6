// SPDX-License-Identifier: Apache-2.0
#include "wire.h"

#include <algorithm>

void Wire::put(double time, std::string_view bytes, const Faults& faults) {
  for (char byte : bytes) {
    if (bytes_.size() >= kMostBytes) return;
    const double duration = faults.bytes_per_second > 0 ? 1 / faults.bytes_per_second : 0;
    free_at_ = std::max(time + faults.delay, free_at_) + duration;
    const double chance = static_cast<double>(random_() >> 11) * 0x1p-53;  // 0 … 1, without 1
    const auto damage = static_cast<char>(1 + random_() % 255);
    bytes_.push_back({free_at_, chance < faults.garbage ? static_cast<char>(byte ^ damage) : byte});
  }
}

std::string Wire::take(double time) {
  std::string taken;
  while (!bytes_.empty() && bytes_.front().due <= time) {
    taken += bytes_.front().value;
    bytes_.pop_front();
  }
  return taken;
}

std::optional<double> Wire::next() const {
  return bytes_.empty() ? std::nullopt : std::optional(bytes_.front().due);
}
