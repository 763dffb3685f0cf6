// SPDX-License-Identifier: Apache-2.0
#include <people/hand_tracks.h>

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include <people/box.h>

namespace hc::people {

void HandTracks::end_old(Time time) {
  std::erase_if(
      all_, [&](const Following& one) { return std::chrono::abs(time - one.track.seen) > kLife; });
}

cv::Point2f HandTracks::Following::moved(Time time) const {
  const auto passed = std::clamp<std::chrono::nanoseconds>(time - track.seen, {}, kMoving);
  return speed * static_cast<float>(seconds(passed));
}

std::vector<HandTracks::Expected> HandTracks::expected(Time time) {
  end_old(time);
  std::vector<Expected> expected;
  for (const Following& one : all_) {
    Region region = region_of(one.track.hand);
    region.middle += one.moved(time);
    expected.push_back({one.track.number, region});
  }
  return expected;
}

void HandTracks::correct(Following& one, Time time, const Hand& hand) {
  constexpr float kShare = 0.5F;    // of a new speed; smooths what the points tremble
  constexpr float kLeast = 0.004F;  // between two images, for the same reason [s]
  const auto passed = static_cast<float>(seconds(time - one.track.seen));
  const cv::Point2f moved = region_of(hand).middle - region_of(one.track.hand).middle;
  if (passed >= kLeast) one.speed += (moved / passed - one.speed) * kShare;
  one.seen_before = std::exchange(one.track.seen, time);
  one.track.hand = hand;
  one.is_seen = true;
}

void HandTracks::continue_lost(Time time, std::vector<Hand> hands) {
  struct Match {
    float overlap = kLeastOverlap;
    std::size_t hand = 0;
    Following* track = nullptr;
  };
  while (true) {
    Match best;
    for (Following& one : all_) {
      if (one.is_seen) continue;
      const cv::Rect2f box = one.track.hand.box() + one.moved(time);
      for (std::size_t i = 0; i < hands.size(); ++i)
        if (const float both = overlap(box, hands[i].box()); both >= best.overlap)
          best = {both, i, &one};
    }
    if (best.track == nullptr) break;
    correct(*best.track, time, hands[best.hand]);
    hands.erase(hands.begin() + static_cast<std::ptrdiff_t>(best.hand));
  }
  for (const Hand& hand : hands) all_.push_back({{++last_, hand, time}, {}, {}, true});
}

void HandTracks::end_doubles() {
  std::vector<const Following*> seen, kept;
  for (const Following& one : all_)
    if (one.is_seen) seen.push_back(&one);
  std::stable_sort(seen.begin(), seen.end(), [](const Following* a, const Following* b) {
    return a->seen_before > b->seen_before;
  });
  std::set<int> doubles;
  for (const Following* one : seen) {
    const cv::Rect2f box = one->track.hand.box();
    const bool is_double = std::any_of(kept.begin(), kept.end(), [&](const Following* other) {
      return overlap(other->track.hand.box(), box) > kSame;
    });
    if (is_double)
      doubles.insert(one->track.number);
    else
      kept.push_back(one);
  }
  std::erase_if(all_, [&](const Following& one) { return doubles.contains(one.track.number); });
}

std::vector<HandTrack> HandTracks::update(Time time, const std::vector<Sighting>& hands) {
  end_old(time);
  for (Following& one : all_) one.is_seen = false;
  for (const Sighting& sighting : hands)
    for (Following& one : all_)
      if (one.track.number == sighting.number) correct(one, time, sighting.hand);
  std::vector<Hand> others;
  for (const Sighting& sighting : hands) {
    if (sighting.number > 0) continue;
    const cv::Rect2f box = sighting.hand.box();
    const auto is_same = [&](const Hand& hand) { return overlap(hand.box(), box) > kSame; };
    const bool is_seen = std::any_of(others.begin(), others.end(), is_same) ||
                         std::any_of(all_.begin(), all_.end(), [&](const Following& one) {
                           return one.is_seen && is_same(one.track.hand);
                         });
    if (!is_seen) others.push_back(sighting.hand);
  }
  continue_lost(time, std::move(others));
  end_doubles();
  std::vector<HandTrack> seen;
  for (const Following& one : all_)
    if (one.is_seen) seen.push_back(one.track);
  return seen;
}

}  // namespace hc::people
