// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rectified pair of eyes and its pose, from the messages of `rectify`. No ports.

#include <array>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <graphics/camera.h>
#include <vision/module_cameras.h>

/// The eyes at the time of an image.
struct Sight {
  hc::graphics::PinholeCamera camera;            ///< of both eyes
  std::array<Eigen::Isometry3d, 2> T_world_eye;  ///< left, right; optical frames
  double scale = 0;                              ///< focal length · baseline [px · m]
  hc::Time time;

  /// A point in an eye's frame [m].
  [[nodiscard]] Eigen::Vector3d in_eye(std::size_t eye, const Eigen::Vector3d& p_world) const {
    return T_world_eye.at(eye).inverse() * p_world;
  }
};

class Pair {
 public:
  /// @see RectifiedMount::take()
  void set_camera(const hc::TimedPose& pose) { mount_.take(pose); }

  /// The eyes at the time of an image.
  [[nodiscard]] Sight at(const hc::Header& image, const hc::vision::PairIntrinsics& intrinsics,
                         hc::ModuleFrames& frames) const;

 private:
  hc::vision::RectifiedMount mount_;
};
