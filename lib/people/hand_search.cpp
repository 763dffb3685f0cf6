// SPDX-License-Identifier: Apache-2.0
#include <people/hand_search.h>

#include <algorithm>
#include <cmath>

#include <people/hand_command.h>
#include <people/sign.h>

namespace hc::people {
namespace {

/// Maximum turn of a palm whose hand may be open and up: beyond that of the sign, since a palm's
/// points are less exact than those of a hand. [rad]
constexpr float kMaxTurn = 1.3F;

}  // namespace

bool SearchTimes::is_due(Time time, bool has_people, bool is_palm) {
  palm_.update(time, is_palm ? Sign::Open : Sign::None);
  is_command_ = is_palm && palm_.held() == Sign::None;
  if (is_command_ || skips_others_) return false;
  if (last_ && std::chrono::abs(time - *last_) < (has_people ? kWithPeople : kWithoutPeople))
    return false;
  last_ = time;
  return true;
}

bool SearchTimes::are_others_due(Time time) {
  skips_others_ = is_command_ && others_ && std::chrono::abs(time - *others_) < kOthers;
  if (!skips_others_) others_ = time;
  return !skips_others_;
}

void HandSearch::add(const HandTracks::Sighting& found,
                     std::vector<HandTracks::Sighting>& hands) const {
  if (found.hand.presence < kHandIsThere) return;
  if (hands.size() < most_ || sign_of(found.hand) == Sign::Open)
    hands.push_back({found.number, with_index_finger(found.hand)});
}

void HandSearch::search(const cv::Mat& image, const std::vector<cv::Rect2f>& faces,
                        std::vector<HandTracks::Sighting>& hands) {
  for (const Palm& palm : palms_.find(image, places_.next(image.size(), faces))) {
    if (hands.size() > most_) return;
    const Region region = region_of(palm);
    if (hands.size() == most_ && std::abs(region.turn) > kMaxTurn) continue;
    const bool is_known = std::any_of(hands.begin(), hands.end(), [&](const auto& one) {
      return one.hand.box().contains(region.middle);
    });
    if (is_known) continue;
    // Once more, in the region that its points give: a palm gives another one.
    const Hand hand = landmarks_.find(image, region);
    if (hand.presence >= kHandIsThere) add({0, landmarks_.find(image, region_of(hand))}, hands);
  }
}

std::vector<HandTrack> HandSearch::look(Time time, const cv::Mat& image,
                                        const std::optional<std::vector<cv::Rect2f>>& faces) {
  if (image.empty()) return {};
  places_.add(image);
  std::vector<HandTracks::Sighting> hands;
  const bool looks_at_all = times_.are_others_due(time);
  std::erase_if(open_, [&](const auto& each) {
    return std::chrono::abs(time - each.second) > HandCommand::kUnseen;
  });
  for (const auto& [number, region] : tracks_.expected(time)) {
    if (hands.size() > most_) break;
    if (!looks_at_all && !open_.contains(number)) continue;
    add({number, landmarks_.find(image, region)}, hands);
  }
  const bool has_people = !hands.empty() || !faces || !faces->empty();
  const auto is_open = [](const auto& one) { return sign_of(one.hand) == Sign::Open; };
  const bool is_palm = std::ranges::any_of(hands, is_open);
  if (times_.is_due(time, has_people, is_palm) && hands.size() <= most_)
    search(image, faces.value_or(std::vector<cv::Rect2f>()), hands);
  auto tracks = tracks_.update(time, hands);
  for (const HandTrack& track : tracks)
    if (is_open(track)) open_[track.number] = time;
  return tracks;
}

}  // namespace hc::people
