// SPDX-License-Identifier: Apache-2.0
#include <hc/base/clock.h>

#include <cstdlib>

namespace hc::internal {
namespace {

constexpr std::int64_t kFar = 100'000'000;  // [ns]
constexpr std::int64_t kSlow = 1000;        // the clock's speed changes by one part of it

}  // namespace

DistantWall distant_wall;

void DistantWall::set(std::int64_t to_wall, MonotonicTime now) {
  const std::int64_t behind = is_set() ? now.count() + to_wall - wall(now) : 0;
  const std::lock_guard lock(mutex_);
  to_wall_ = to_wall;
  behind_ = std::abs(behind) > kFar ? 0 : behind;
  since_ = now;
  is_set_ = true;
}

std::int64_t DistantWall::wall(MonotonicTime now) const {
  const std::lock_guard lock(mutex_);
  const auto made_up = std::max<std::int64_t>(0, (now - since_).count()) / kSlow;
  return now.count() + to_wall_ - behind_ + std::clamp(behind_, -made_up, made_up);
}

}  // namespace hc::internal
