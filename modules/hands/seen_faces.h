// SPDX-License-Identifier: Apache-2.0
#pragma once
// The faces in view, from the table of module `faces`. No ports.

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <opencv2/core/types.hpp>

#include <hc/base/time.h>
#include <hc/module/kind.h>

class SeenFaces {
 public:
  /// How long a face stays where it was seen.
  static constexpr std::chrono::milliseconds kLife{500};
  /// How long somebody is taken to be in view after their face was; then hands are sought less
  /// often.
  static constexpr std::chrono::milliseconds kInView{3000};
  /// The most faces that count, the first of a table, since each takes time in every image.
  static constexpr std::size_t kMost = 64;
  /// Maximum distance of a hand from the eyes of its person. [m]
  static constexpr double kArm = 1.1;

  /// Takes a table, of rows as people/face_table.h has them.
  void take(hc::Time time, const hc::MatrixView<const double>& table);
  /// The eyes nearest to a finger tip, of a face seen at about that time.
  /// @param tip  in the camera's frame [m].
  [[nodiscard]] std::optional<Eigen::Vector3d> eyes_near(
      hc::Time time, const Eigen::Vector3d& tip, const Eigen::Isometry3d& T_head_camera) const;
  /// The boxes of the faces that were seen last, those of people in view. [px]
  [[nodiscard]] std::vector<cv::Rect2f> boxes(hc::Time time) const;

 private:
  hc::Time time_, in_view_;
  std::vector<cv::Rect2f> boxes_;
  std::vector<Eigen::Vector3d> eyes_;  // the middles between them, in the head's frame [m]
};
