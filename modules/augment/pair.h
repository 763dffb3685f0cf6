// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two eyes, as `rectify` describes them, and where they are. Knows no ports.

#include <array>
#include <optional>
#include <span>

#include <frames/messages.h>
#include <frames/module_frames.h>
#include <graphics/camera.h>

/// The eyes at the time of an image.
struct Sight {
  hc::graphics::PinholeCamera camera;            ///< either eye's
  std::array<Eigen::Isometry3d, 2> T_world_eye;  ///< left and right, optical
  double scale = 0;                              ///< focal length · baseline [px · m]
  std::int64_t time = 0;                         ///< [ns]

  /// A point as an eye has it.
  [[nodiscard]] Eigen::Vector3d in_eye(std::size_t eye, const Eigen::Vector3d& p_world) const {
    return T_world_eye.at(eye).inverse() * p_world;
  }
};

class Pair {
 public:
  /// Takes fx, fy, cx, cy [px], baseline [m]; false if that is no pair.
  bool set_intrinsics(std::span<const double> numbers);
  /// Takes T_head_left_eye, or from the left camera of the pair to the left eye; others are none
  /// of its business.
  void set_camera(const hc::TimedPose& pose);

  /// The eyes as they took an image.
  ///
  /// @param focal  what is assumed until intrinsics are known [px]; then the baseline is that of
  /// the frames, and the optical axis goes through the middle.
  [[nodiscard]] Sight at(const hc::Header& image, double focal, hc::ModuleFrames& frames) const;

 private:
  double fx_ = 0, fy_ = 0, cx_ = 0, cy_ = 0, baseline_ = 0;  // fx 0: unknown
  std::optional<Eigen::Isometry3d> T_head_left_;
  Eigen::Isometry3d T_left_rectified_ = Eigen::Isometry3d::Identity();
};
