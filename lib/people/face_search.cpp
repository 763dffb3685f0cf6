// SPDX-License-Identifier: Apache-2.0
#include <people/face_search.h>

#include <algorithm>
#include <cmath>

#include <people/box.h>

namespace hc::people {
namespace {

constexpr float kSameFace = 0.3F;  // least overlap
// Large faces are searched in a square around the image. Its side, and their least width, both as a
// share of the image's shorter side. Source: photographs with faces of 0.8 and 1.05 of it.
constexpr double kMargin = 2;
constexpr float kLarge = 0.4F;
constexpr std::size_t kMostLarge = 4;

/// The faces around a box, as in a picture of one person, for which the small network was made.
/// None for a box that is far outside the image, too large or not finite.
std::vector<Face> find_around(FaceFinder& finder, const cv::Mat& image, const cv::Rect2f& box,
                              float least) {
  constexpr float kAround = 2.5F;  // sides of the box
  const cv::Point2f middle = (box.tl() + box.br()) / 2;
  const float side = kAround * std::max(box.width, box.height);
  // A track that jumps may be expected anywhere, with any size.
  const auto most = 8 * static_cast<float>(std::max(image.cols, image.rows));
  if (!(side <= most && std::abs(middle.x) <= most && std::abs(middle.y) <= most)) return {};
  const cv::Rect square(cv::Rect2f(middle.x - side / 2, middle.y - side / 2, side, side));
  if ((square & cv::Rect({}, image.size())).empty()) return {};
  return finder.find(image, square, least);
}

FaceTracks::Sighting* same_face(const Face& face, std::vector<FaceTracks::Sighting>& faces) {
  const auto found = std::ranges::find_if(faces, [&](const FaceTracks::Sighting& other) {
    return overlap(face.box, other.face.box) > kSameFace;
  });
  return found == faces.end() ? nullptr : &*found;
}

}  // namespace

Result<FaceSearch> FaceSearch::read() {
  auto wide = HC_TRY(FaceFinder::read_wide());
  auto near = HC_TRY(FaceFinder::read_near());
  return FaceSearch(std::move(wide), std::move(near));
}

std::vector<Face> FaceSearch::look_around(const cv::Mat& image, const cv::Rect2f& box,
                                          float least) {
  return find_around(near_, image, box, least);
}

bool FaceSearch::follows(int track, Time time) const {
  return std::ranges::count(expected(time), track, &FaceTracks::Expected::number) > 0;
}

std::vector<FaceSearch::Sighting> FaceSearch::followed(Time time, const cv::Mat& image,
                                                       float least) {
  auto boxes = tracks_.expected(time);
  if (boxes.size() > kMostFollowed) boxes.resize(kMostFollowed);
  std::vector<Face> faces;
  for (const auto& [number, box] : boxes) {
    const auto found = look_around(image, box, least);
    faces.insert(faces.end(), found.begin(), found.end());
  }
  std::vector<Sighting> all;
  for (const Face& face : merged(std::move(faces))) all.push_back({face});
  return all;
}

std::optional<Face> FaceSearch::refined(const cv::Mat& image, const Face& face, float least) {
  for (const Face& near : look_around(image, face.box, least))
    if (overlap(near.box, face.box) > kSameFace) return near;
  return std::nullopt;
}

void FaceSearch::add(const cv::Mat& image, const Face& face, float least,
                     std::vector<Sighting>& faces) {
  const float sure = std::max(face.score < kLikely ? kSureElsewhere : kSure, least);
  auto* same = same_face(face, faces);
  if (same == nullptr || same->face.score < sure) {
    const auto near = refined(image, face, least);
    if (!near) return;
    if (same == nullptr) same = same_face(*near, faces);
    if (same == nullptr) same = &faces.emplace_back(Sighting{*near});
    if (near->score > same->face.score) same->face = *near;
  }
  same->may_be_new = same->may_be_new || same->face.score >= sure;
}

void FaceSearch::add_large(Time time, const cv::Mat& image, float least,
                           std::vector<Sighting>& faces) {
  const int shorter = std::min(image.cols, image.rows), side = cvRound(kMargin * shorter);
  const cv::Rect square((image.cols - side) / 2, (image.rows - side) / 2, side, side);
  auto found = near_.find(image, square, std::max(kSure, least));
  std::erase_if(found, [&](const Face& face) {
    const auto is_same = [&](const auto& other) { return overlap(face.box, other) > kSameFace; };
    return face.box.width < kLarge * static_cast<float>(shorter) ||
           std::ranges::any_of(tracks_.expected(time), is_same, &FaceTracks::Expected::box) ||
           std::ranges::any_of(faces, [&](const Sighting& other) {
             return other.may_be_new && is_same(other.face.box);
           });
  });
  if (found.size() > kMostLarge) found.resize(kMostLarge);
  for (const Face& face : found)
    for (const Face& large : find_around(wide_, image, face.box, kPossible))
      if (overlap(large.box, face.box) > kSameFace) {
        add(image, large, least, faces);
        break;
      }
}

std::vector<Track> FaceSearch::look(Time time, const cv::Mat& image, float least,
                                    const cv::Matx33f& turn) {
  if (image.empty()) return {};
  tracks_.turn(turn);
  const auto parts = parts_of(image.size(), wide_.size());
  auto faces = followed(time, image, least);
  const auto period = faces.empty() ? kSearch : kSweep;
  const auto due = static_cast<std::size_t>(std::chrono::abs(time - swept_) / period);
  if (due > 0) swept_ = time;
  for (std::size_t i = 0; i < std::min(due, parts.size()); ++i) {
    auto found = wide_.find(image, parts[next_part_++ % parts.size()], kPossible);
    if (found.size() > kMostFound) found.resize(kMostFound);
    for (const Face& face : found) add(image, face, least, faces);
    if (next_part_ % parts.size() == 0) add_large(time, image, least, faces);
  }
  return tracks_.update(time, faces);
}

}  // namespace hc::people
