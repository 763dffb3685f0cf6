// SPDX-License-Identifier: Apache-2.0
#include "seen_faces.h"

#include <utility>

#include <people/face_table.h>

void SeenFaces::take(hc::Time time, const hc::MatrixView<const double>& table) {
  time_ = time;
  eyes_.clear();
  std::vector<cv::Rect2f> boxes;
  for (std::size_t i = 0; i < table.height() && boxes.size() < kMost; ++i)
    if (const auto row = hc::people::face_in(table.row(i))) {
      if (hc::people::can_be_face(row->place)) eyes_.push_back(row->place);
      boxes.push_back(row->face.box);
    }
  if (boxes.empty()) return;  // they may only have turned away
  boxes_ = std::move(boxes);
  in_view_ = time;
}

std::vector<cv::Rect2f> SeenFaces::boxes(hc::Time time) const {
  return std::chrono::abs(time - in_view_) < kInView ? boxes_ : std::vector<cv::Rect2f>();
}

std::optional<Eigen::Vector3d> SeenFaces::eyes_near(hc::Time time, const Eigen::Vector3d& tip,
                                                    const Eigen::Isometry3d& T_head_camera) const {
  std::optional<Eigen::Vector3d> nearest;
  if (std::chrono::abs(time - time_) > kLife) return nearest;
  for (const auto& p_head : eyes_) {
    const Eigen::Vector3d p = T_head_camera.inverse() * p_head;
    if (!(p.z() > 0) || (p - tip).norm() > kArm) continue;
    if (!nearest || (p - tip).norm() < (*nearest - tip).norm()) nearest = p;
  }
  return nearest;
}
