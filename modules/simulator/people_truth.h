// SPDX-License-Identifier: Apache-2.0
#pragma once
// The outputs with ground truth about persons, for scoring.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/camera.h>
#include <hc/module/module.h>

#include <room/person.h>
#include <room/truth_rows.h>

/// A person as an eye sees them.
///
/// @param index  of the person.
hc::room::PersonRow row_of(std::span<const hc::room::Person> people, std::size_t index,
                           const Eigen::Isometry3d& T_world_eye,
                           const hc::graphics::PinholeCamera& camera);

/// A joint of a hand as an eye sees it.
hc::room::JointRow joint_row(const hc::room::Person& person, int side, int joint,
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
