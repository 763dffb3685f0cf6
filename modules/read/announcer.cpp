// SPDX-License-Identifier: Apache-2.0
#include "announcer.h"

bool Announcer::take(const std::string& text, double confidence, std::int64_t time,
                     const Rules& rules, bool is_heard) {
  if (text.empty() || confidence < rules.confidence) {
    times_ = 0;
    return false;
  }
  times_ = times_ > 0 && text == read_ ? times_ + 1 : 1;
  read_ = text;
  if (times_ < rules.repeat) return false;
  // A clock that went back, as that of a recording which begins anew, does not silence it.
  const auto since = static_cast<double>(time - said_at_) * 1e-9;
  const bool is_due = rules.again > 0 && (since >= rules.again || since < 0);
  if (text == said_ && !is_due && (was_heard_ || !is_heard)) return false;
  said_ = text;
  was_heard_ = is_heard;
  said_at_ = time;
  return true;
}
