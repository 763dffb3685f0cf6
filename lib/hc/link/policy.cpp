// SPDX-License-Identifier: Apache-2.0
#include <hc/link/policy.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace hc::internal {

constexpr std::int64_t kTick = 1'000'000'000;  // parts of a token, and nanoseconds of a second

Result<Policy> parse_policy(const Uri& uri) {
  Policy policy;
  auto kept = uri.option("keep", "all");
  if (kept != "all") {
    auto keep = kept == "latest" ? 1 : number_option(uri, "keep", 1, {1, TokenBucket::kMost});
    if (!keep) return Error{Code::Invalid, "option keep is all, latest, or a number of messages"};
    policy.keep = static_cast<std::size_t>(*keep);
  }
  for (auto [key, has_units, value] : {std::tuple{"rate", false, &policy.rate},
                                       {"burst", false, &policy.burst},
                                       {"memory", true, &policy.memory}}) {
    const auto default_value = static_cast<std::int64_t>(*value);
    auto number =
        HC_TRY(number_option(uri, key, default_value, {1, TokenBucket::kMost, has_units}));
    *value = static_cast<std::uint64_t>(number);
  }
  constexpr std::int64_t kLongest = 86'400;  // [s]
  const auto timeout = HC_TRY(number_option(uri, "timeout", 0, {0, kLongest}));
  policy.timeout = std::chrono::seconds(timeout);
  if (policy.rate == 0 && !uri.option("burst", "").empty())
    return Error{Code::Invalid, "option burst needs rate"};
  return policy;
}

// `rate` parts of 1e-9 token are added per nanosecond, which is exact.
TokenBucket::TokenBucket(std::uint64_t rate, std::uint64_t burst)
    : rate_(static_cast<std::int64_t>(rate)),
      capacity_(static_cast<std::int64_t>(burst) * kTick),
      level_(capacity_) {
  HC_CHECK(rate <= kMost && burst <= kMost, rate, burst);
}

void TokenBucket::fill(TimePoint now) {
  if (filled_ == TimePoint::min()) filled_ = now;
  std::int64_t elapsed = std::max<std::int64_t>(0, (now - filled_).count());
  filled_ = std::max(filled_, now);
  // Written so that the product cannot overflow.
  bool fills = elapsed > (capacity_ - level_) / rate_;
  level_ = fills ? capacity_ : level_ + elapsed * rate_;
}

TimePoint TokenBucket::ready_at(TimePoint now) {
  if (rate_ == 0) return now;
  fill(now);
  if (level_ >= kTick) return now;
  return now + std::chrono::nanoseconds((kTick - level_ + rate_ - 1) / rate_);
}

void TokenBucket::take(TimePoint now) {
  if (rate_ == 0) return;
  fill(now);
  level_ -= kTick;
}

bool Patience::waits(std::uint64_t taken, TimePoint now) {
  if (!began_) began_ = now;
  if (std::exchange(taken_, taken) != taken || !last_taken_) last_taken_ = now;
  if (timeout_.count() > 0 && now - *last_taken_ >= timeout_) {
    end();
    is_over_ = true;
    if (log_)
      log_(Level::Warning, "the reader has read nothing for " + std::to_string(timeout_.count()) +
                               " s; dropping its messages until it reads again");
    return false;
  }
  if (on_long_wait_ && now - *began_ >= kLong && !std::exchange(is_reported_, true))
    on_long_wait_(true);
  return true;
}

void Patience::end() {
  began_.reset();
  last_taken_.reset();
  if (std::exchange(is_reported_, false)) on_long_wait_(false);
}

TimePoint Patience::due() const {
  auto due = TimePoint::max();
  if (last_taken_ && timeout_.count() > 0) due = *last_taken_ + timeout_;
  if (began_ && on_long_wait_ && !is_reported_) due = std::min(due, *began_ + kLong);
  return due;
}

bool Patience::is_over(std::uint64_t taken) {
  if (!is_over_ || taken == taken_) return is_over_;
  is_over_ = false;
  if (log_) log_(Level::Warning, "the reader reads again");
  return false;
}

}  // namespace hc::internal
