// SPDX-License-Identifier: Apache-2.0
#include <room/scenery.h>

namespace hc::room {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;

Isometry3d hang(const Vector3d& middle, double yaw) {
  Eigen::Matrix3d optical;  // columns: x right, y down, z forward
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Translation3d(middle) * AngleAxisd(yaw, Vector3d::UnitZ()) * Isometry3d(optical);
}

double Scenery::random(double least, double most) {
  cv::RNG random(state_);
  const double value = random.uniform(least, most);
  state_ = random.state;
  return value;
}

void Scenery::add(const graphics::Mesh& mesh, const cv::Mat& texture, const Isometry3d& place) {
  items_.push_back({renderer_.add(mesh, texture), place.cast<float>()});
}

void Scenery::add_box(const Vector3d& size, const Vector3d& middle, const cv::Mat& texture,
                      double yaw) {
  const Isometry3d place(Translation3d(middle) * AngleAxisd(yaw, Vector3d::UnitZ()));
  add(graphics::make_box(size.cast<float>()), texture, place);
  auto& corners = boxes_.emplace_back();
  const Eigen::AlignedBox3d box(-size / 2, size / 2);
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = place * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
}

void Scenery::move_last(const Vector3d& middle) {
  items_.back().T_world_object = Isometry3d(Translation3d(middle)).cast<float>();
}

}  // namespace hc::room
