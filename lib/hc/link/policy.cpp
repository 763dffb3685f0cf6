// SPDX-License-Identifier: Apache-2.0
#include <hc/link/policy.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include <hc/base/text.h>

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
  if (const auto bandwidth = uri.option("bandwidth", ""); !bandwidth.empty())
    policy.bandwidth = HC_TRY(parse_bandwidth(bandwidth));
  constexpr std::int64_t kLongest = 86'400;  // [s]
  const auto timeout = HC_TRY(number_option(uri, "timeout", 0, {0, kLongest}));
  policy.timeout = std::chrono::seconds(timeout);
  if (policy.rate == 0 && !uri.option("burst", "").empty())
    return Error{Code::Invalid, "option burst needs rate"};
  return policy;
}

Result<std::uint64_t> parse_bandwidth(std::string_view text) {
  constexpr double kLeast = 1e3, kMost = 4e9;  // [byte/s]
  constexpr std::string_view kPrefixes = "kMG";
  const auto digits = text.substr(0, text.find_first_not_of("0123456789."));
  auto unit = text.substr(digits.size());
  if (unit.starts_with(' ')) unit.remove_prefix(1);
  double number = 0, factor = 1;
  if (const auto prefix = kPrefixes.find(unit.substr(0, 1)); !unit.empty() && prefix < 3) {
    factor = std::pow(1000, prefix + 1);
    unit.remove_prefix(1);
  }
  if (unit == "bit/s") factor /= 8;
  const bool is_unit = unit == "bit/s" || unit == "B/s" || (unit.empty() && factor == 1);
  if (!is_unit || !read_number(digits, number) || number * factor < kLeast ||
      number * factor > kMost)
    return Error{Code::Invalid,
                 "option bandwidth is from 1 kB/s to 4 GB/s, as in 500 kB/s, 2 MB/s "
                 "or 5 Mbit/s, not \"" +
                     std::string(text) + '"'};
  return static_cast<std::uint64_t>(number * factor);
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

TimePoint TokenBucket::ready_at(TimePoint now, std::uint64_t amount) {
  if (rate_ == 0) return now;
  fill(now);
  const auto wanted = static_cast<std::int64_t>(std::min(amount, kMost)) * kTick;
  const auto missing = std::min(wanted, capacity_) - level_;
  if (missing <= 0) return now;
  return now + std::chrono::nanoseconds((missing - 1) / rate_ + 1);
}

void TokenBucket::take(TimePoint now, std::uint64_t amount) {
  if (rate_ == 0) return;
  fill(now);
  // Not below -kMost tokens, so that no sum overflows; a message has less than 4 GB.
  level_ -= static_cast<std::int64_t>(std::min(amount, kMost)) * kTick;
  level_ = std::max(level_, -static_cast<std::int64_t>(kMost) * kTick);
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
