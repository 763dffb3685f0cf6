// SPDX-License-Identifier: Apache-2.0
#include <people/search_places.h>

#include <algorithm>

#include <people/box.h>

namespace hc::people {
namespace {

/// Where a person's palm is held up: from above the head to the elbows, an arm's length to each
/// side. Empty if that is not in the image, or larger than twice the image.
cv::Rect reach_of(const cv::Rect2f& face, const cv::Size& image) {
  const float side = 8 * face.width;
  const cv::Rect2f reach(face.x + (face.width - side) / 2, face.y + 1.5F * face.height - side / 2,
                         side, side);
  const auto most = 2 * static_cast<float>(std::max(image.width, image.height));
  if (side > most || (reach & cv::Rect2f({}, cv::Size2f(image))).empty()) return {};
  return reach;
}

}  // namespace

cv::Rect SearchPlaces::next(const cv::Size& image, const std::vector<cv::Rect2f>& faces) {
  const std::size_t turn = turn_++ % 3;
  cv::Rect next, of;
  double most = -1;
  for (std::size_t i = 0; turn < 2 && i < faces.size(); ++i) {
    const auto place = reach_of(faces[i], image);
    if (place.empty()) continue;
    // Of the faces alone, since their surroundings overlap.
    const double due = turn == 0 ? changes_.change(place) : changes_.age(faces[i]);
    if (due <= most) continue;
    most = due;
    next = place;
    of = faces[i];
  }
  if (!next.empty()) {
    changes_.forget_change(next);
    changes_.forget_age(of);
    return next;
  }
  // A hand near by is seen as a whole in the whole image alone, and one far away in a part.
  std::vector<cv::Rect> parts{{{}, image}};
  for (const cv::Rect& part : parts_of(image))
    if (part.size() != image) parts.push_back(part);
  return parts[next_part_++ % parts.size()];
}

}  // namespace hc::people
