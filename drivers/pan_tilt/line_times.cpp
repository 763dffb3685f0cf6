// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/line_times.h>

#include <algorithm>
#include <utility>

namespace hc::pan_tilt {

void LineTimes::forget() {
  written_ = {};
  unsent_ = 0;
  unsent_question_.reset();
  looks_.clear();
  delay_.reset();
  tilt_.reset();
}

void LineTimes::asked(MonotonicTime now) {
  looks_.push_back({now, std::max(written_, now) + on_line(unsent_)});
  unsent_question_ = unsent_;
}

void LineTimes::wrote(MonotonicTime now) {
  const auto begins = std::max(written_, now);
  if (unsent_question_ && !looks_.empty())
    looks_.back() = {now, begins + on_line(*unsent_question_)};
  unsent_question_.reset();
  written_ = begins + on_line(std::exchange(unsent_, 0));
}

void LineTimes::answered(MonotonicTime now, bool begins) {
  const auto before = std::exchange(answered_, now);
  if (begins) heard_after_ = before;
}

MonotonicTime LineTimes::heard(std::size_t bytes) {
  heard_bytes_ = bytes;
  look_ = looks_.front();
  looks_.pop_front();
  return look_.time;
}

MonotonicTime LineTimes::seen_at(MonotonicTime now) {
  // When the answer began, at the latest; it is complete before its last byte, the line feed.
  const auto begun = now - on_line(heard_bytes_ - 1);
  if (begun < look_.sent)
    return look_.time + (now - look_.time) / 2;  // the line is faster than set
  const auto free = std::min(std::max(look_.sent, heard_after_), begun);
  const auto delay = begun - free;
  constexpr int kRecent = 16;
  // While earlier answers are on the line, they hide the unit's own delay.
  if (!delay_ || free == look_.sent)
    delay_ = std::min(delay, delay_.value_or(delay) + (delay - delay_.value_or(delay)) / kRecent);
  return look_.sent + *delay_ / 2;
}

double LineTimes::tilt_at(MonotonicTime time, double seen, std::size_t bytes) {
  const auto last = std::exchange(tilt_, Tilt{time, seen});
  if (!last || time <= last->time) return seen;
  const double later = hc::seconds(on_line(bytes));
  return seen - (seen - last->seen) * std::min(1.0, later / hc::seconds(time - last->time));
}

std::chrono::nanoseconds LineTimes::on_line(std::size_t bytes) const {
  if (bytes_per_second_ <= 0) return {};
  return duration(static_cast<double>(bytes) / bytes_per_second_);
}

}  // namespace hc::pan_tilt
