// SPDX-License-Identifier: Apache-2.0
#pragma once
// The eyes of the people who are seen, from the table of module `faces`. No ports.

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <hc/base/time.h>
#include <hc/module/kind.h>
#include <vision/calibration.h>

/// The middle between a person's eyes.
struct SeenEyes {
  Eigen::Vector2d pixel;                  ///< in the image of the left eye [px]
  std::optional<Eigen::Vector3d> p_head;  ///< in the head's frame [m]
  double distance = 0;                    ///< without p_head: from the camera [m]; 0: unknown
};

class SeenFaces {
 public:
  /// How long a face stays where it was seen.
  static constexpr std::chrono::milliseconds kLife{500};
  /// Maximum distance of a hand from the eyes of its person. [m]
  static constexpr double kArm = 1.1;

  /// Takes a table: in each row the right eye in columns 7 and 8, the left eye in 9 and 10, and in
  /// columns 21 to 23 the middle between the eyes, or in 21 alone its distance.
  ///
  /// Errors: Unsupported (fewer columns).
  hc::Status take(hc::Time time, const hc::MatrixView<const double>& table);
  /// The eyes nearest to a finger tip, of a face seen at about that time.
  /// @param tip  in the camera's frame [m].
  [[nodiscard]] std::optional<Eigen::Vector3d> eyes_near(
      hc::Time time, const Eigen::Vector3d& tip, const hc::vision::Pinhole& camera,
      const Eigen::Isometry3d& T_head_camera) const;

 private:
  hc::Time time_;
  std::vector<SeenEyes> eyes_;
};
