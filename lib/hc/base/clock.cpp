// SPDX-License-Identifier: Apache-2.0
#include <hc/base/clock.h>

#include <cstdlib>

namespace hc::internal {
namespace {

constexpr std::int64_t kFar = 100'000'000;  // [ns]
constexpr std::int64_t kSlow = 1000;        // the clock's speed changes by one part of it

/// What is left to make up for, `passed` after it was `behind` [ns].
std::int64_t still_behind(std::int64_t behind, std::int64_t passed) {
  const std::int64_t made_up = std::max<std::int64_t>(0, passed) / kSlow;
  return behind > 0 ? std::max<std::int64_t>(0, behind - made_up)
                    : std::min<std::int64_t>(0, behind + made_up);
}

}  // namespace

DistantWall distant_wall;

void DistantWall::set(std::int64_t to_wall, MonotonicTime now) {
  const std::int64_t before = is_set() ? wall(now) - now.count() : to_wall;
  const std::int64_t behind = to_wall - before;
  const auto version = version_.load(std::memory_order_relaxed);
  version_.store(version + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  to_wall_.store(to_wall, std::memory_order_relaxed);
  behind_.store(std::abs(behind) > kFar ? 0 : behind, std::memory_order_relaxed);
  since_.store(now.count(), std::memory_order_relaxed);
  version_.store(version + 2, std::memory_order_release);
}

std::int64_t DistantWall::wall(MonotonicTime now) const {
  while (true) {
    const auto version = version_.load(std::memory_order_acquire);
    const auto to_wall = to_wall_.load(std::memory_order_relaxed),
               behind = behind_.load(std::memory_order_relaxed),
               since = since_.load(std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_acquire);
    if (version % 2 == 0 && version_.load(std::memory_order_relaxed) == version)
      return now.count() + to_wall - still_behind(behind, now.count() - since);
  }
}

}  // namespace hc::internal
