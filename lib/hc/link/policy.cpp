// SPDX-License-Identifier: Apache-2.0
#include <hc/link/policy.h>

#include <algorithm>
#include <charconv>
#include <string>
#include <tuple>
#include <utility>

namespace hc::internal {
namespace {

constexpr std::int64_t kTick = 1'000'000'000;  // parts of a token, as a second has nanoseconds

/// Reads a number above 0, perhaps of K, M or G where `units` allow it.
Status read(const Uri& uri, std::string_view key, bool units, std::uint64_t& value) {
  auto text = uri.option(key, "");
  if (text.empty()) return {};
  std::string_view digits = text;
  int shift = 0;
  if (auto unit = std::string_view("KMG").find(digits.back());
      units && unit != std::string_view::npos) {
    shift = 10 * (static_cast<int>(unit) + 1);
    digits.remove_suffix(1);
  }
  std::uint64_t number = 0;
  const char* end = digits.data() + digits.size();
  auto [stop, status] = std::from_chars(digits.data(), end, number);
  if (stop != end || status != std::errc() || number == 0 || number > (TokenBucket::kMost >> shift))
    return Error{Code::Invalid, "option " + std::string(key) + " is a whole number from 1 to " +
                                    std::to_string(TokenBucket::kMost) +
                                    (units ? ", also as K, M or G" : "")};
  value = number << shift;
  return {};
}

}  // namespace

Result<Policy> parse_policy(const Uri& uri) {
  Policy policy;
  std::uint64_t keep = 1;
  auto kept = uri.option("keep", "all");
  if (kept != "all" && kept != "latest")
    if (auto got = read(uri, "keep", false, keep); !got)
      return Error{Code::Invalid, "option keep is all, latest, or how many messages"};
  if (kept != "all") policy.keep = keep;
  for (auto [key, units, value] : {std::tuple{"rate", false, &policy.rate},
                                   {"burst", false, &policy.burst},
                                   {"memory", true, &policy.memory}})
    if (auto got = read(uri, key, units, *value); !got) return got.error();
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

}  // namespace hc::internal
