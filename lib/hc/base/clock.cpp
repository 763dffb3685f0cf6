// SPDX-License-Identifier: Apache-2.0
#include <hc/base/clock.h>

#include <algorithm>

namespace hc::internal {
namespace {

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

constexpr nanoseconds kMaxSlewed = 100ms;  // larger differences are stepped
constexpr int kSlewDivisor = 1000;         // slews by 1/1000 of the elapsed time
constexpr nanoseconds kMostToWall{4'000'000'000'000'000'000};  // differences do not overflow

}  // namespace

DistantWall distant_wall;

void DistantWall::set(nanoseconds to_wall, MonotonicTime now) {
  to_wall = std::clamp(to_wall, -now, kMostToWall);
  const auto behind = is_set() ? Time(now + to_wall) - wall(now) : 0ns;
  const std::lock_guard lock(mutex_);
  to_wall_ = to_wall;
  behind_ = std::chrono::abs(behind) > kMaxSlewed ? 0ns : behind;
  since_ = now;
  is_set_ = true;
}

Time DistantWall::wall(MonotonicTime now) const {
  const std::lock_guard lock(mutex_);
  const auto slewed = std::max<nanoseconds>(0ns, now - since_) / kSlewDivisor;
  return Time(now + to_wall_ - behind_ + std::clamp(behind_, -slewed, slewed));
}

}  // namespace hc::internal
