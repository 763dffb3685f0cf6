// SPDX-License-Identifier: Apache-2.0
#include <people/hand_search.h>

#include <algorithm>
#include <cmath>

#include <people/box.h>
#include <people/sign.h>

namespace hc::people {
namespace {

/// Maximum turn of a palm whose hand may be open and up: beyond that of the sign, since a palm's
/// points are less exact than those of a hand. [rad]
constexpr float kMayBeUp = 1.3F;

/// Where a person's palm is held up: from above the head to the elbows, an arm's length to each
/// side. Empty if that is not in the image, or more than it.
cv::Rect reach_of(const cv::Rect2f& face, const cv::Size& image) {
  const float side = 8 * face.width;
  const cv::Rect2f reach(face.x + (face.width - side) / 2, face.y + 1.5F * face.height - side / 2,
                         side, side);
  const auto most = 2 * static_cast<float>(std::max(image.width, image.height));
  if (side > most || (reach & cv::Rect2f({}, cv::Size2f(image))).empty()) return {};
  return reach;
}

}  // namespace

bool SearchTimes::is_due(Time time, bool is_anybody, bool is_palm) {
  if (!is_palm) palm_.reset();
  if (is_palm && !palm_) palm_ = time;
  if (palm_ && std::chrono::abs(time - *palm_) < kPalm) return false;
  if (last_ && std::chrono::abs(time - *last_) < (is_anybody ? kSomebody : kNobody)) return false;
  last_ = time;
  return true;
}

void HandSearch::add(const HandTracks::Sighting& found,
                     std::vector<HandTracks::Sighting>& hands) const {
  if (found.hand.presence < kHandIsThere) return;
  if (hands.size() < most_ || sign_of(found.hand) == Sign::Open) hands.push_back(found);
}

cv::Rect HandSearch::next_place(const cv::Size& image, const std::vector<cv::Rect2f>& faces) {
  const std::size_t turn = turn_++ % 3;
  cv::Rect next;
  double most = -1;
  for (std::size_t i = 0; turn < 2 && i < faces.size(); ++i) {
    const auto place = reach_of(faces[i], image);
    if (place.empty()) continue;
    const double due = turn == 0 ? changes_.change(place) : changes_.age(place);
    if (due <= most) continue;
    most = due;
    next = place;
  }
  if (!next.empty()) return next;
  // A hand near by is seen as a whole in the whole image alone, and one far away in a part.
  std::vector<cv::Rect> parts{{{}, image}};
  for (const cv::Rect& part : parts_of(image))
    if (part.size() != image) parts.push_back(part);
  return parts[next_part_++ % parts.size()];
}

void HandSearch::search(const cv::Mat& image, const std::vector<cv::Rect2f>& faces,
                        std::vector<HandTracks::Sighting>& hands) {
  const cv::Rect place = next_place(image.size(), faces);
  changes_.forget(place);
  for (const Palm& palm : palms_.find(image, place)) {
    if (hands.size() > most_) return;
    const Region region = region_of(palm);
    const bool may_be_up = std::abs(region.turn) < kMayBeUp;
    if (hands.size() == most_ && !may_be_up) continue;
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
  changes_.add(image);
  std::vector<HandTracks::Sighting> hands;
  for (const auto& [number, region] : tracks_.expected(time)) {
    if (hands.size() > most_) break;
    add({number, landmarks_.find(image, region)}, hands);
  }
  const bool is_anybody = !hands.empty() || !faces || !faces->empty();
  const bool is_palm =
      std::ranges::any_of(hands, [](const auto& one) { return sign_of(one.hand) == Sign::Open; });
  if (times_.is_due(time, is_anybody, is_palm) && hands.size() <= most_)
    search(image, faces.value_or(std::vector<cv::Rect2f>()), hands);
  return tracks_.update(time, hands);
}

}  // namespace hc::people
