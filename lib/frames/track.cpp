// SPDX-License-Identifier: Apache-2.0
#include <frames/track.h>

#include <algorithm>
#include <iterator>

namespace hc::frames {

std::deque<Track::Sample>::const_iterator Track::first_from(std::int64_t time) const {
  return std::lower_bound(samples_.begin(), samples_.end(), time,
                          [](const Sample& sample, std::int64_t t) { return sample.time < t; });
}

Fed Track::add(std::int64_t time, const Pose& pose) {
  HC_CHECK(time > 0, time);
  if (samples_.empty() || time > samples_.back().time) {
    samples_.push_back({time, pose});
  } else {
    if (samples_.back().time - time > memory_.span.count()) return Fed::TooOld;
    auto next = first_from(time);
    if (next->time == time) {
      samples_[static_cast<std::size_t>(next - samples_.cbegin())].pose = pose;
      return Fed::Replaced;
    }
    if (next == samples_.cbegin() && samples_.size() == memory_.poses) return Fed::TooOld;
    samples_.insert(next, {time, pose});
  }
  while (samples_.size() > memory_.poses ||
         samples_.back().time - samples_.front().time > memory_.span.count())
    samples_.pop_front();
  return Fed::Added;
}

TimeSpan Track::known() const {
  HC_CHECK(!samples_.empty());
  return {samples_.front().time, samples_.back().time};
}

std::optional<TimeSpan> Track::gap_at(std::int64_t time) const {
  auto next = first_from(time);
  HC_CHECK(next != samples_.end(), time);
  if (next->time == time) return std::nullopt;
  HC_CHECK(next != samples_.begin(), time);
  auto before = std::prev(next);
  if (!is_gap(*before, *next)) return std::nullopt;
  return TimeSpan{before->time, next->time};
}

std::optional<TimeSpan> Track::known_until(std::int64_t time) const {
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

Pose Track::at(std::int64_t time) const {
  auto next = first_from(time);
  HC_CHECK(next != samples_.end(), time);
  if (next->time == time) return next->pose;
  HC_CHECK(next != samples_.begin(), time);
  auto before = std::prev(next);
  HC_CHECK(!is_gap(*before, *next), time);
  return between(
      before->pose, next->pose,
      static_cast<double>(time - before->time) / static_cast<double>(next->time - before->time));
}

Pose Track::nearest(std::int64_t time) const {
  const auto [first, last] = known();
  time = std::clamp(time, first, last);
  const auto gap = gap_at(time);
  return at(gap ? gap->first : time);
}

}  // namespace hc::frames
