// SPDX-License-Identifier: Apache-2.0
#include <people/face_tracks.h>

#include <algorithm>
#include <cmath>

#include <people/box.h>

namespace hc::people {
namespace {

// Of a face that is one unit wide.
constexpr float kNoise = 0.05F;     // σ of a measurement [widths]
constexpr float kAcceleration = 8;  // σ of the motion [widths/s²]
constexpr float kFirstSpeed = 3;    // σ at first [widths/s]

cv::Point3f place_of(const Face& face) {
  return {face.box.x + face.box.width / 2, face.box.y + face.box.height / 2, face.box.width};
}

}  // namespace

bool FaceTracks::Following::is_over(Time time) const {
  const auto unseen = time - track.seen;
  return unseen > kLongest || unseen < -kLife || (unseen > kLife && misses >= kMisses);
}

cv::Point3f FaceTracks::Following::predicted(Time time) const {
  return at + speed * static_cast<float>(seconds(time - track.seen));
}

cv::Rect2f FaceTracks::Following::box(Time time) const {
  const cv::Point3f now = predicted(time);
  const float width = std::max(now.z, 1.F);
  const float height = width * track.face.box.height / std::max(track.face.box.width, 1.F);
  return {now.x - width / 2, now.y - height / 2, width, height};
}

std::array<float, 3> FaceTracks::Following::predicted_covariance(Time time) const {
  const auto dt = std::max(static_cast<float>(seconds(time - track.seen)), 0.F);
  const float q = kAcceleration * kAcceleration;
  return {p[0] + 2 * dt * p[1] + dt * dt * p[2] + q * dt * dt * dt * dt / 4,
          p[1] + dt * p[2] + q * dt * dt * dt / 2, p[2] + q * dt * dt};
}

std::optional<float> FaceTracks::Following::cost(Time time, const Face& face) const {
  const float width = std::max(at.z, 1.F);
  const cv::Point3f off = (place_of(face) - predicted(time)) / width;
  const float variance = predicted_covariance(time)[0] + kNoise * kNoise;
  const float gate = std::min(kGate * std::sqrt(variance), kWidestGate);
  if (off.dot(off) > gate * gate && overlap(face.box, box(time)) < kLeastOverlap)
    return std::nullopt;
  return off.dot(off) / variance + 3 * std::log(variance * width * width);
}

void FaceTracks::Following::correct(Time time, const Face& face) {
  const cv::Point3f before = predicted(time), seen = place_of(face);
  p = predicted_covariance(time);
  const float all = p[0] + kNoise * kNoise, gain = p[0] / all, gain_of_speed = p[1] / all;
  p[2] -= gain_of_speed * p[1];
  p[1] *= 1 - gain;
  p[0] *= 1 - gain;
  at = before + (seen - before) * gain;
  speed += (seen - before) * gain_of_speed;
  track.face = face;
  track.seen = time;
  misses = 0;
}

std::vector<Track> FaceTracks::update(Time time, const std::vector<Sighting>& faces) {
  std::erase_if(all_, [&](const Following& one) { return one.is_over(time); });
  for (Following& one : all_) ++one.misses;
  struct Pair {
    float cost;
    std::size_t face, track;
  };
  std::vector<Pair> pairs;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t t = 0; t < all_.size(); ++t)
      if (const auto cost = all_[t].cost(time, faces[f].face)) pairs.push_back({*cost, f, t});
  std::sort(pairs.begin(), pairs.end(),
            [](const Pair& a, const Pair& b) { return a.cost < b.cost; });
  std::vector<int> of_face(faces.size(), -1);
  std::vector<bool> is_taken(all_.size());
  for (const Pair& pair : pairs) {
    if (of_face[pair.face] >= 0 || is_taken[pair.track]) continue;
    of_face[pair.face] = static_cast<int>(pair.track);
    is_taken[pair.track] = true;
  }
  std::vector<Track> seen;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto& [face, may_be_new] = faces[f];
    if (of_face[f] >= 0) {
      all_[static_cast<std::size_t>(of_face[f])].correct(time, face);
    } else if (may_be_new) {
      of_face[f] = static_cast<int>(all_.size());
      all_.push_back({{++last_, face, time}, place_of(face), {}, {}});
      all_.back().p = {kNoise * kNoise, 0, kFirstSpeed * kFirstSpeed};
    } else {
      continue;
    }
    seen.push_back(all_[static_cast<std::size_t>(of_face[f])].track);
  }
  return seen;
}

void FaceTracks::turn(const cv::Matx33f& H) {
  for (Following& one : all_) {
    const cv::Vec3f to = H * cv::Vec3f(one.at.x, one.at.y, 1);
    if (!(to[2] > 0)) continue;  // behind the camera
    one.at.x = to[0] / to[2];
    one.at.y = to[1] / to[2];
  }
}

std::vector<FaceTracks::Expected> FaceTracks::expected(Time time) const {
  std::vector<Expected> all;
  for (const Following& one : all_)
    if (!one.is_over(time)) all.push_back({one.track.number, one.box(time)});
  return all;
}

}  // namespace hc::people
