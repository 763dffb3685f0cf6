// SPDX-License-Identifier: Apache-2.0
#include <people/hand_tracks.h>

#include <algorithm>

#include <people/box.h>

namespace hc::people {

void HandTracks::end_old(Time time) {
  std::erase_if(
      all_, [&](const Following& one) { return std::chrono::abs(time - one.track.seen) > kLife; });
}

std::vector<HandTracks::Expected> HandTracks::expected(Time time) {
  end_old(time);
  std::vector<Expected> expected;
  for (const Following& one : all_) {
    Region region = region_of(one.track.hand);
    const auto passed = std::clamp<std::chrono::nanoseconds>(time - one.track.seen, {}, kMoving);
    region.middle += one.speed * static_cast<float>(seconds(passed));
    expected.push_back({one.track.number, region});
  }
  return expected;
}

void HandTracks::correct(Following& one, Time time, const Hand& hand) {
  constexpr float kShare = 0.5F;  // of a new speed; smooths what the points tremble
  const auto passed = static_cast<float>(seconds(time - one.track.seen));
  const cv::Point2f moved = region_of(hand).middle - region_of(one.track.hand).middle;
  if (passed > 0) one.speed += (moved / passed - one.speed) * kShare;
  one.track.hand = hand;
  one.track.seen = time;
}

std::vector<HandTrack> HandTracks::update(Time time, const std::vector<Sighting>& hands) {
  end_old(time);
  std::vector<bool> is_seen(all_.size());
  const auto known = all_.size();
  for (const Sighting& sighting : hands)
    for (std::size_t i = 0; sighting.number > 0 && i < known; ++i)
      if (all_[i].track.number == sighting.number) {
        correct(all_[i], time, sighting.hand);
        is_seen[i] = true;
      }
  for (const Sighting& sighting : hands) {
    if (sighting.number > 0) continue;
    const cv::Rect2f box = sighting.hand.box();
    std::size_t at = 0;
    for (; at < all_.size(); ++at)  // one that was seen is the same hand
      if (overlap(all_[at].track.hand.box(), box) > (is_seen[at] ? kSame : 0)) break;
    if (at < all_.size() && is_seen[at]) continue;
    if (at == all_.size()) {
      all_.push_back({{++last_, sighting.hand, time}, {}});
      is_seen.push_back(true);
    } else {
      correct(all_[at], time, sighting.hand);
      is_seen[at] = true;
    }
  }
  std::vector<Following> kept;
  std::vector<HandTrack> seen;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const auto box = all_[i].track.hand.box();
    const bool is_double = std::any_of(kept.begin(), kept.end(), [&](const Following& one) {
      return overlap(one.track.hand.box(), box) > kSame;
    });
    if (is_double) continue;
    kept.push_back(all_[i]);
    if (is_seen[i]) seen.push_back(all_[i].track);
  }
  all_ = std::move(kept);
  return seen;
}

}  // namespace hc::people
