// SPDX-License-Identifier: Apache-2.0
#include <people/face_distances.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hc::people {
namespace {

constexpr float kFaceWidth = 0.15F;  // of the box of an adult's face [m]
constexpr std::chrono::seconds kKept{1};

/// The points that a turn of the head moves least.
constexpr Face::Point kMiddle[] = {Face::RightEye, Face::LeftEye, Face::Nose, Face::Mouth};

}  // namespace

float distance_by_size(const Face& face, const FacePair& pair) {
  return pair.focal * kFaceWidth / std::max(face.box.width, 1.F);
}

cv::Rect2f expected_in_right(const Face& left, const FacePair& pair) {
  return left.box - cv::Point2f(pair.baseline / kFaceWidth * left.box.width, 0);
}

std::optional<float> distance_by_eyes(const Face& left, const std::vector<Face>& right,
                                      const FacePair& pair) {
  std::optional<float> found;
  float least = left.box.width / 4;  // between the heights of the points [px]
  for (const Face& other : right) {
    float shift = 0, apart = 0;
    for (const auto point : kMiddle) {
      const cv::Point2f by = left.points[point] - other.points[point];
      shift += by.x / static_cast<float>(std::size(kMiddle));
      apart += std::abs(by.y) / static_cast<float>(std::size(kMiddle));
    }
    const float size = other.box.width / std::max(left.box.width, 1.F);
    if (!(shift > 0) || apart > least || size < 0.7F || size > 1.4F) continue;
    least = apart;
    found = pair.focal * pair.baseline / shift;
  }
  return found;
}

std::vector<std::size_t> FaceDistances::due(Time time, const std::vector<Track>& seen) {
  const auto passed = [&](const auto& looked) { return std::chrono::abs(time - looked.second); };
  std::erase_if(looked_, [&](const auto& each) { return passed(each) > kKept; });
  std::vector<std::pair<Time, std::size_t>> all;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto looked = looked_.find(seen[i].number);
    if (looked == looked_.end())
      all.emplace_back(Time::min(), i);
    else if (seconds(passed(*looked)) >= kSmoothing)
      all.emplace_back(looked->second, i);
  }
  std::ranges::sort(all);
  all.resize(std::min(all.size(), (seen.size() + 3) / 4));
  std::vector<std::size_t> places;
  for (const auto& [looked, place] : all) {
    looked_[seen[place].number] = time;
    places.push_back(place);
  }
  return places;
}

void FaceDistances::add(int track, Time time, float distance) {
  std::erase_if(
      known_, [&](const auto& each) { return std::chrono::abs(time - each.second.time) > kKept; });
  const auto [found, is_new] = known_.try_emplace(track, Known{time, distance});
  if (is_new) return;
  Known& known = found->second;
  const double passed = seconds(std::chrono::abs(time - known.time));
  const auto gain = static_cast<float>(1 - std::exp(-passed / kSmoothing));
  known.distance += (distance - known.distance) * gain;
  known.time = time;
}

std::optional<float> FaceDistances::find(int track, Time time) const {
  const auto found = known_.find(track);
  if (found == known_.end() || std::chrono::abs(time - found->second.time) > kKept)
    return std::nullopt;
  return found->second.distance;
}

}  // namespace hc::people
