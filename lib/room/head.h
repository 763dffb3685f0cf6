// SPDX-License-Identifier: Apache-2.0
#pragma once
// A head's pose, and the mounting of its eyes, nominal and with the faults of a real head. Pure.

#include <Eigen/Geometry>

#include <room/scenery.h>

namespace hc::room {

/// T_world_head of a head at kHeadHeight.
///
/// @param pan  > 0: left [rad].
/// @param tilt  > 0: down [rad].
inline Eigen::Isometry3d head_pose(double pan, double tilt) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return Eigen::Translation3d(0, 0, kHeadHeight) * AngleAxisd(pan, Vector3d::UnitZ()) *
         Eigen::Isometry3d(AngleAxisd(tilt, Vector3d::UnitY()));
}

/// Errors of a real head, to be found by calibration [rad].
struct HeadFaults {
  double zero_pan = 0, zero_tilt = 0;  ///< rotation of the eyes' bar with the unit at 0
  double offset_roll = 0, offset_pitch = 0, offset_yaw = 0;  ///< of the right eye, in its own frame
};

/// T_head_eye: from an eye's optical frame (x right, y down, z forward) to the head's (x forward, y
/// left, z up), whose origin is the intersection of the pan and tilt axes.
struct Head {
  Eigen::Isometry3d left_eye, right_eye;

  /// The eyes of graphs/simulated_head.toml, 0.1 m apart.
  static Head nominal() { return {hang({0.06, 0.05, 0.05}, 0), hang({0.06, -0.05, 0.05}, 0)}; }

  /// The same with faults.
  [[nodiscard]] Head with(const HeadFaults& faults) const {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    const Eigen::Quaterniond bar = AngleAxisd(faults.zero_pan, Vector3d::UnitZ()) *
                                   AngleAxisd(faults.zero_tilt, Vector3d::UnitY());
    const Eigen::Quaterniond offset = AngleAxisd(faults.offset_pitch, Vector3d::UnitX()) *
                                      AngleAxisd(faults.offset_yaw, Vector3d::UnitY()) *
                                      AngleAxisd(faults.offset_roll, Vector3d::UnitZ());
    return {bar * left_eye, bar * right_eye * offset};
  }
};

}  // namespace hc::room
