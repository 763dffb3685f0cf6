// SPDX-License-Identifier: Apache-2.0
#include "seen_faces.h"

#include <hc/base/format.h>

hc::Status SeenFaces::take(hc::Time time, const hc::MatrixView<const double>& table) {
  constexpr std::size_t kRightEye = 7, kLeftEye = 9, kPlace = 21;
  const std::size_t columns = table.width() * table.components();
  if (!table.empty() && columns <= kPlace)
    return hc::Error{hc::Code::Unsupported,
                     hc::format("a table of {} columns is none of faces", columns)};
  time_ = time;
  eyes_.clear();
  for (std::size_t y = 0; y < table.height(); ++y) {
    const auto row = table.row(y);
    SeenEyes seen;
    seen.pixel = {(row[kRightEye] + row[kLeftEye]) / 2,
                  (row[kRightEye + 1] + row[kLeftEye + 1]) / 2};
    if (columns >= kPlace + 3)
      seen.p_head = Eigen::Vector3d(row[kPlace], row[kPlace + 1], row[kPlace + 2]);
    else
      seen.distance = row[kPlace];
    eyes_.push_back(seen);
  }
  return {};
}

std::optional<Eigen::Vector3d> SeenFaces::eyes_near(hc::Time time, const Eigen::Vector3d& tip,
                                                    const hc::vision::Pinhole& camera,
                                                    const Eigen::Isometry3d& T_head_camera) const {
  std::optional<Eigen::Vector3d> nearest;
  if (std::chrono::abs(time - time_) > kLife) return nearest;
  for (const auto& [pixel, p_head, distance] : eyes_) {
    const Eigen::Vector3d ray((pixel.x() - camera.cx) / camera.fx,
                              (pixel.y() - camera.cy) / camera.fy, 1);
    const Eigen::Vector3d p = p_head ? Eigen::Vector3d(T_head_camera.inverse() * *p_head)
                                     : Eigen::Vector3d(distance * ray.normalized());
    if (!p.allFinite() || !(p.z() > 0) || (p - tip).norm() > kArm) continue;
    if (!nearest || (p - tip).norm() < (*nearest - tip).norm()) nearest = p;
  }
  return nearest;
}
