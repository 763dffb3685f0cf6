// SPDX-License-Identifier: Apache-2.0
#include <people/face_search.h>

#include <algorithm>
#include <cmath>

#include <people/box.h>

namespace hc::people {
namespace {

constexpr float kSameFace = 0.3F;  // least overlap
constexpr float kLarge = 0.4F;     // width of a large face, by the image's shorter side
constexpr float kMargin = 1.5F;    // side of the square in which it is sought, by the longer one

cv::Rect2f square_around(const cv::Rect2f& box, float times) {
  const cv::Point2f middle = (box.tl() + box.br()) / 2;
  const float side = times * std::max(box.width, box.height);
  return {middle.x - side / 2, middle.y - side / 2, side, side};
}

/// Where to look for the face of a box: as in a picture of one person, for which the small network
/// was made. Empty if that is outside the image, or if the box is not finite.
cv::Rect around(const cv::Mat& image, const cv::Rect2f& box) {
  const cv::Rect2f square = square_around(box, 2.5F);
  // A track that jumps may be expected anywhere, with any size.
  const auto most = 8 * static_cast<float>(std::max(image.cols, image.rows));
  if (!(square.width <= most && std::abs(square.x) <= most && std::abs(square.y) <= most))
    return {};
  const cv::Rect all(square);
  return (all & cv::Rect({}, image.size())).empty() ? cv::Rect{} : all;
}

FaceTracks::Sighting* same_face(const Face& face, std::vector<FaceTracks::Sighting>& faces) {
  const auto found = std::ranges::find_if(faces, [&](const FaceTracks::Sighting& other) {
    return overlap(face.box, other.face.box) > kSameFace;
  });
  return found == faces.end() ? nullptr : &*found;
}

}  // namespace

std::vector<Face> FaceSearch::look_around(const cv::Mat& image, const cv::Rect2f& box,
                                          float least) {
  const cv::Rect place = around(image, box);
  return place.empty() ? std::vector<Face>{} : near_.find(image, place, least);
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
  const float sure = std::max(kSure, least);
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

void FaceSearch::add_large(const cv::Mat& image, float least, std::vector<Sighting>& faces) {
  const float wide = kLarge * static_cast<float>(std::min(image.cols, image.rows));
  const cv::Rect whole(square_around({{}, cv::Size2f(image.size())}, kMargin));
  for (const Face& large : near_.find(image, whole, std::max(kSure, least))) {
    if (large.box.width < wide || same_face(large, faces) != nullptr) continue;
    const cv::Rect place = around(image, large.box);
    if (place.empty()) continue;
    for (const Face& face : wide_.find(image, place, least)) add(image, face, least, faces);
  }
}

std::vector<Track> FaceSearch::look(Time time, const cv::Mat& image, float least,
                                    const cv::Matx33f& turn) {
  if (image.empty()) return {};
  tracks_.turn(turn);
  const auto parts = parts_of(image.size());
  auto faces = followed(time, image, least);
  const auto period = faces.empty() ? kSearch : kSweep;
  const auto due = static_cast<std::size_t>(std::chrono::abs(time - swept_) / period);
  if (due > 0) swept_ = time;
  for (std::size_t i = 0; i < std::min(due, parts.size()); ++i) {
    if (next_part_ % parts.size() == 0) add_large(image, least, faces);
    auto found = wide_.find(image, parts[next_part_++ % parts.size()], least);
    if (found.size() > kMostFound) found.resize(kMostFound);
    for (const Face& face : found) add(image, face, least, faces);
  }
  return tracks_.update(time, faces);
}

}  // namespace hc::people
