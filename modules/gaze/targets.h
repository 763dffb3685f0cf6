// SPDX-License-Identifier: Apache-2.0
#pragma once
// Computes where the head has to look, from targets and the head's pose at their time. No messages.

#include <cstdint>
#include <optional>
#include <utility>

#include <gaze/binocular.h>
#include <gaze/follower.h>
#include <hc/base/clock.h>
#include <vision/calibration.h>

/// Coordinate systems of targets (spec/mtp-1.md, R44).
inline constexpr std::int32_t kRobot = 2, kHead = 3, kLeftEye = 4, kRightEye = 5, kLeftImage = 7,
                              kRightImage = 8;

/// Times are of any one clock.
class Targets {
 public:
  /// @param distance  assumed of a target seen by one eye only [m].
  Targets(hc::gaze::Eyes eyes, const hc::gaze::FollowerOptions& options, double distance)
      : eyes_(std::move(eyes)), distance_(distance), follower_(options) {}

  /// Takes calibrated cameras and, if measured, their mounting on the head.
  /// Errors: Malformed (as hc::gaze::HeadCalibration::of).
  hc::Status calibrate(const hc::vision::StereoCalibration& cameras);
  void calibrate(const hc::gaze::HeadCalibration& calibration) { eyes_.calibrate(calibration); }

  /// The frame of a target: the head's if `coord` is an eye or its image, else `coord`.
  [[nodiscard]] static std::int32_t frame_of(std::int32_t coord);
  /// Takes a target: x, y in an image [px], or a position in a frame [m].
  /// @param T_robot_frame  of frame_of(coord) at that time.
  void see(hc::Time time, std::int32_t coord, const Eigen::Vector3d& p,
           const Eigen::Isometry3d& T_robot_frame);
  /// Takes a setpoint instead of a target.
  void set(hc::Time time, const hc::gaze::Angles& setpoint) {
    follower_.see(hc::seconds(time.time_since_epoch()), setpoint);
  }

  [[nodiscard]] const hc::gaze::Eyes& eyes() const { return eyes_; }
  /// The filtered target; times in seconds.
  [[nodiscard]] const hc::gaze::Follower& follower() const { return follower_; }

 private:
  /// Position in the head's frame [m].
  std::optional<Eigen::Vector3d> place(hc::Time time, hc::gaze::Side side, Eigen::Vector2d pixel);

  hc::gaze::Eyes eyes_;
  double distance_;
  hc::gaze::Follower follower_;
  std::optional<hc::vision::StereoCalibration> cameras_;
  hc::gaze::Binocular binocular_;
};
