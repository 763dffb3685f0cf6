// SPDX-License-Identifier: Apache-2.0
#pragma once
// The outputs with ground truth about persons, for scoring.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/camera.h>
#include <hc/module/module.h>

#include <room/person.h>

/// A person as a row: number (from 1), x y z of the middle between the eyes in the world [m], yaw
/// of the face in the world [rad], whether the person speaks (0 or 1), u v of that middle, width of
/// the face [px], visible share of the face (0 … 1). The last four are 0 behind the eye.
///
/// @param index  of the person.
std::array<double, 10> row_of(std::span<const hc::room::Person> people, std::size_t index,
                              const Eigen::Isometry3d& T_world_eye,
                              const hc::graphics::PinholeCamera& camera);

/// A joint of a hand as a row: number of the person (from 1), hand (0 left, 1 right), joint (0 …
/// 20, as MediaPipe has them), x y z in the world [m], u v [px]; u v are 0 behind the eye.
std::array<double, 8> joint_row(const hc::room::Person& person, int side, int joint,
                                const Eigen::Isometry3d& T_world_eye,
                                const hc::graphics::PinholeCamera& camera);

class PeopleTruth {
 public:
  explicit PeopleTruth(hc::Module& module);

  /// Sends nothing if there is nobody.
  void send(hc::Time time, const std::vector<hc::room::Person>& people,
            const Eigen::Isometry3d& T_world_left, const hc::graphics::PinholeCamera& camera);

 private:
  using Tables = hc::Output<decltype(hc::table())>;

  void send_joints(hc::Time time, const std::vector<hc::room::Person>& people,
                   const Eigen::Isometry3d& T_world_left,
                   const hc::graphics::PinholeCamera& camera);

  Tables people_, hand_joints_, pointed_;
};
