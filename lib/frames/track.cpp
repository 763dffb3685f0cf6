// SPDX-License-Identifier: Apache-2.0
#include <frames/track.h>

#include <algorithm>
#include <iterator>

namespace hc::frames {

std::deque<Track::Sample>::const_iterator Track::first_from(Time time) const {
  return std::lower_bound(samples_.begin(), samples_.end(), time,
                          [](const Sample& sample, Time t) { return sample.time < t; });
}

Fed Track::add(Time time, const Pose& pose) {
  HC_CHECK(time > Time(), unix_nanoseconds(time));
  if (samples_.empty() || time > samples_.back().time) {
    samples_.push_back({time, pose});
  } else {
    if (samples_.back().time - time > memory_.span) return Fed::TooOld;
    auto next = first_from(time);
    if (next->time == time) {
      samples_[static_cast<std::size_t>(next - samples_.cbegin())].pose = pose;
      return Fed::Replaced;
    }
    if (next == samples_.cbegin() && samples_.size() == memory_.poses) return Fed::TooOld;
    samples_.insert(next, {time, pose});
  }
  while (samples_.size() > memory_.poses ||
         samples_.back().time - samples_.front().time > memory_.span)
    samples_.pop_front();
  return Fed::Added;
}

TimeSpan Track::known() const {
  HC_CHECK(!samples_.empty());
  return {samples_.front().time, samples_.back().time};
}

std::optional<TimeSpan> Track::gap_at(Time time) const {
  auto next = first_from(time);
  HC_CHECK(next != samples_.end(), unix_nanoseconds(time));
  if (next->time == time) return std::nullopt;
  HC_CHECK(next != samples_.begin(), unix_nanoseconds(time));
  auto before = std::prev(next);
  if (!is_gap(*before, *next)) return std::nullopt;
  return TimeSpan{before->time, next->time};
}

std::optional<TimeSpan> Track::known_until(Time time) const {
  auto next = first_from(time);
  const bool exact = next != samples_.end() && next->time == time;
  if (!exact && next == samples_.begin()) return std::nullopt;
  auto first = exact ? next : std::prev(next);
  TimeSpan span{first->time, first->time};
  if (!exact && next != samples_.end() && !is_gap(*first, *next)) span.last = time;
  while (first != samples_.begin() && !is_gap(*std::prev(first), *first)) --first;
  span.first = first->time;
  return span;
}

Pose Track::at(Time time) const {
  auto next = first_from(time);
  HC_CHECK(next != samples_.end(), unix_nanoseconds(time));
  if (next->time == time) return next->pose;
  HC_CHECK(next != samples_.begin(), unix_nanoseconds(time));
  using Nanoseconds = std::chrono::duration<double, std::nano>;
  auto before = std::prev(next);
  HC_CHECK(!is_gap(*before, *next), unix_nanoseconds(time));
  return between(before->pose, next->pose,
                 Nanoseconds(time - before->time) / (next->time - before->time));
}

Pose Track::nearest(Time time) const {
  const auto [first, last] = known();
  time = std::clamp(time, first, last);
  const auto gap = gap_at(time);
  return at(gap ? gap->first : time);
}

}  // namespace hc::frames
