// SPDX-License-Identifier: Apache-2.0
#include "announcer.h"

#include <algorithm>
#include <cstddef>

#include <hc/base/clock.h>

namespace {

/// Whether two texts differ by only one or two adjacent letters, probably misread.
bool are_near(const std::string& a, const std::string& b) {
  constexpr std::ptrdiff_t kMost = 2;
  constexpr std::size_t kLong = 5;  // shorter texts are similar by chance
  if (a.size() > b.size()) return are_near(b, a);
  if (a.size() < kLong || static_cast<std::ptrdiff_t>(b.size() - a.size()) > kMost) return false;
  const auto [begin_a, begin_b] = std::mismatch(a.begin(), a.end(), b.begin());
  const auto [end_a, end_b] = std::mismatch(a.rbegin(), a.rend(), b.rbegin());
  return end_b.base() - begin_b <= kMost || end_a.base() - begin_a <= kMost;
}

}  // namespace

bool Announcer::take(const std::string& text, double confidence, hc::Time time, const Rules& rules,
                     bool is_heard) {
  const bool is_sure = !text.empty() && confidence >= rules.confidence;
  readings_.push_back(is_sure ? text : "");
  constexpr std::int64_t kDoubt = 3;
  const bool is_doubtful = text != said_ && are_near(text, said_);
  const std::int64_t wanted = is_doubtful ? kDoubt * rules.repeat : rules.repeat;
  while (std::ssize(readings_) > 2 * kDoubt * rules.repeat - 1) readings_.pop_front();
  const auto first = readings_.end() - std::min(std::ssize(readings_), 2 * wanted - 1);
  if (!is_sure || std::count(first, readings_.end(), text) < wanted) return false;
  // A clock may go back when a recording restarts: announce then, too.
  const auto since = hc::seconds(time - said_at_);
  const bool is_due = rules.again > 0 && (since >= rules.again || since < 0);
  if (text == said_ && !is_due && (was_heard_ || !is_heard)) return false;
  said_ = text;
  was_heard_ = is_heard;
  said_at_ = time;
  ++texts_;
  return true;
}

std::string Announcer::summary() const {
  if (texts_ == 0) return {};
  return "read " + std::to_string(texts_) + (texts_ == 1 ? " text" : " texts") + ", the last \"" +
         said_ + "\"";
}
