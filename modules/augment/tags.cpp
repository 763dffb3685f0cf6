// SPDX-License-Identifier: Apache-2.0
#include "tags.h"

#include <algorithm>

#include <graphics/mesh.h>
#include <graphics/text.h>

namespace {

using hc::graphics::Body;

// Of a plate's image [px].
constexpr int kScale = 2, kStroke = 3, kCapitals = 46;  // with the stroke
constexpr int kMargin = 14, kRows = 80, kBase = 60;
constexpr double kMetre = kCapitals / Tags::kCapital;  // [px/m]

/// White letters on a dark plate: legible on any image.
cv::Mat paint_plate(const std::string& name) {
  const auto pen = hc::graphics::pen_for(name, cv::Scalar::all(255));
  int below = 0;
  const int width = pen.measure(name, kScale, kStroke, below).width;
  cv::Mat plate(kRows, std::max(width, 0) + 2 * kMargin, CV_8UC3, cv::Scalar(25, 30, 45));
  pen.write(plate, name, {kMargin, kBase}, kScale, kStroke);
  return plate;
}

/// T_world_plate of an upright plate that faces a point. Its axes are those of an image.
Eigen::Isometry3d facing(const Eigen::Vector3d& p_plate, const Eigen::Vector3d& p_viewer) {
  constexpr double kOver = 1e-6;  // [m]
  Eigen::Vector3d ahead = p_plate - p_viewer;
  ahead.z() = 0;
  if (ahead.norm() < kOver) ahead = Eigen::Vector3d::UnitX();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = p_plate;
  T.linear().col(2) = ahead.normalized();
  T.linear().col(1) = -Eigen::Vector3d::UnitZ();
  T.linear().col(0) = T.linear().col(1).cross(T.linear().col(2));
  return T;
}

}  // namespace

void Tags::place(const std::vector<NamedFace>& faces, const Sight& sight) {
  drop_unused(faces);
  placed_.clear();
  const auto& [left, right] = sight.T_world_eye;
  const Eigen::Vector3d p_viewer = (left.translation() + right.translation()) / 2;
  for (const auto& [name, p_world] : faces) {
    const Eigen::Vector3d p_plate = p_world + kAbove * Eigen::Vector3d::UnitZ();
    if (sight.in_eye(0, p_plate).z() < kNearest) continue;
    placed_.push_back(plate(name));
    placed_.back().T_world_body = facing(p_plate, p_viewer);
  }
}

void Tags::drop_unused(const std::vector<NamedFace>& faces) {
  if (plates_.size() + faces.size() <= kMostPlates) return;
  for (auto at = plates_.begin(); at != plates_.end();) {
    const bool is_used =
        std::ranges::any_of(faces, [&](const auto& face) { return face.name == at->first; });
    if (is_used) {
      ++at;
      continue;
    }
    for (const auto surface : at->second.surfaces) renderer_.remove(surface);
    at = plates_.erase(at);
  }
}

const Body& Tags::plate(const std::string& name) {
  const auto [at, is_new] = plates_.try_emplace(name);
  if (is_new) {
    const cv::Mat image = paint_plate(name);
    const auto metres = [](int pixels) { return static_cast<float>(pixels / kMetre); };
    at->second = hc::graphics::make_body(
        renderer_, {{hc::graphics::make_rectangle(metres(image.cols), metres(image.rows)), image}});
  }
  return at->second;
}
