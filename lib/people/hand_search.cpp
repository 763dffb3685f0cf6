// SPDX-License-Identifier: Apache-2.0
#include <people/hand_search.h>

#include <algorithm>

#include <people/box.h>
#include <people/sign.h>

namespace hc::people {

bool SearchTimes::is_due(Time time, std::size_t followed, bool is_anybody) {
  const auto period = followed > 0 ? kSome : is_anybody ? kNone : kNobody;
  if (last_ && std::chrono::abs(time - *last_) < period) return false;
  last_ = time;
  return true;
}

void HandSearch::add(const HandTracks::Sighting& found,
                     std::vector<HandTracks::Sighting>& hands) const {
  if (found.hand.presence < kHandIsThere) return;
  if (hands.size() < most_ || sign_of(found.hand) == Sign::Open) hands.push_back(found);
}

void HandSearch::search(const cv::Mat& image, std::vector<HandTracks::Sighting>& hands) {
  // A hand near by is seen as a whole in the whole image alone, and one far away in a part.
  std::vector<cv::Rect> parts{{{}, image.size()}};
  for (const cv::Rect& part : parts_of(image.size()))
    if (part.size() != image.size()) parts.push_back(part);
  for (const Palm& palm : palms_.find(image, parts[next_part_++ % parts.size()])) {
    if (hands.size() > most_) return;
    const cv::Point2f middle = region_of(palm).middle;
    const bool is_known = std::any_of(hands.begin(), hands.end(), [&](const auto& one) {
      return one.hand.box().contains(middle);
    });
    if (is_known) continue;
    add({0, landmarks_.find(image, region_of(palm))}, hands);
  }
}

std::vector<HandTrack> HandSearch::look(Time time, const cv::Mat& image, bool is_anybody) {
  if (image.empty()) return {};
  std::vector<HandTracks::Sighting> hands;
  for (const auto& [number, region] : tracks_.expected(time)) {
    if (hands.size() > most_) break;
    add({number, landmarks_.find(image, region)}, hands);
  }
  if (hands.size() <= most_ && times_.is_due(time, hands.size(), is_anybody)) search(image, hands);
  return tracks_.update(time, hands);
}

}  // namespace hc::people
