// SPDX-License-Identifier: Apache-2.0
#include <graph/run/restarts.h>

namespace hc::internal {

void Restarts::started(MonotonicTime now) {
  std::erase_if(starts_, [&](MonotonicTime start) { return now - start >= limits_.window; });
  starts_.push_back(now);
}

Restarts::Decision Restarts::ended(int status, MonotonicTime now) {
  if (status == 0 && policy_ != Restart::Always) return {Next::End, {}};
  if (policy_ == Restart::Never || status == kBadArguments) return {Next::GiveUp, {}};
  forget_after_long_run(now);
  std::erase_if(starts_, [&](MonotonicTime start) { return now - start >= limits_.window; });
  if (delayed_ == 0 && starts_.size() < limits_.starts_at_once) return {Next::Again, {}};
  if (delayed_ == limits_.delayed_starts) return {Next::GiveUp, {}};
  ++delayed_;
  const auto whole = delay_.next();
  std::uniform_int_distribution<std::int64_t> within(whole.count() / 2, whole.count());
  return {Next::Again, std::chrono::nanoseconds(within(random_))};
}

Restarts::Decision Restarts::lost(MonotonicTime now) {
  if (policy_ == Restart::Never) return {Next::GiveUp, {}};
  forget_after_long_run(now);
  if (!starts_.empty()) starts_.pop_back();
  return {Next::Again, {}};
}

void Restarts::forget_after_long_run(MonotonicTime now) {
  if (!starts_.empty() && now - starts_.back() >= limits_.window) reset();
}

void Restarts::reset() {
  starts_.clear();
  delayed_ = 0;
  delay_.reset();
}

}  // namespace hc::internal
