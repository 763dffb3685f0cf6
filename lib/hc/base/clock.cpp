// SPDX-License-Identifier: Apache-2.0
#include <hc/base/clock.h>

#include <cstdlib>

namespace hc::internal {
namespace {

constexpr std::int64_t kMaxSlewed = 100'000'000;  // [ns]; larger differences are stepped
constexpr std::int64_t kSlewDivisor = 1000;       // slews by 1/1000 of the elapsed time

}  // namespace

DistantWall distant_wall;

void DistantWall::set(std::int64_t to_wall, MonotonicTime now) {
  const std::int64_t behind = is_set() ? now.count() + to_wall - wall(now) : 0;
  const std::lock_guard lock(mutex_);
  to_wall_ = to_wall;
  behind_ = std::abs(behind) > kMaxSlewed ? 0 : behind;
  since_ = now;
  is_set_ = true;
}

std::int64_t DistantWall::wall(MonotonicTime now) const {
  const std::lock_guard lock(mutex_);
  const auto slewed = std::max<std::int64_t>(0, (now - since_).count()) / kSlewDivisor;
  return now.count() + to_wall_ - behind_ + std::clamp(behind_, -slewed, slewed);
}

}  // namespace hc::internal
