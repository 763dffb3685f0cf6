// SPDX-License-Identifier: Apache-2.0
#include <hc/link/policy.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

namespace hc::internal {

constexpr std::int64_t kTick = 1'000'000'000;  // parts of a token, as a second has nanoseconds

Result<Policy> parse_policy(const Uri& uri) {
  Policy policy;
  auto kept = uri.option("keep", "all");
  if (kept != "all") {
    auto keep = kept == "latest" ? 1 : number_option(uri, "keep", 1, {1, TokenBucket::kMost});
    if (!keep) return Error{Code::Invalid, "option keep is all, latest, or how many messages"};
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
    return Error{Code::Invalid, "option burst wants rate beside it"};
  return policy;
}

// A token is 1e9 parts, so that `rate` of them come every nanosecond, without a remainder.
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
  // The product is taken only where it cannot overflow.
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
      log_(Level::Warning, "the reader has taken nothing for " + std::to_string(timeout_.count()) +
                               " s: messages to it are dropped until it does");
    return false;
  }
  if (tell_ && now - *began_ >= kLong && !std::exchange(is_told_, true)) tell_(true);
  return true;
}

void Patience::end() {
  began_.reset();
  last_taken_.reset();
  if (std::exchange(is_told_, false)) tell_(false);
}

TimePoint Patience::due() const {
  auto due = TimePoint::max();
  if (last_taken_ && timeout_.count() > 0) due = *last_taken_ + timeout_;
  if (began_ && tell_ && !is_told_) due = std::min(due, *began_ + kLong);
  return due;
}

bool Patience::is_over(std::uint64_t taken) {
  if (!is_over_ || taken == taken_) return is_over_;
  is_over_ = false;
  if (log_) log_(Level::Warning, "the reader takes messages again");
  return false;
}

}  // namespace hc::internal
