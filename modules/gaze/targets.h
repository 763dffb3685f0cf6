// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the head has to look for what was seen, by where it was then. No messages.

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

/// Times are in nanoseconds since any one origin.
class Targets {
 public:
  /// @param distance  of a target that one eye alone has seen [m].
  Targets(hc::gaze::Eyes eyes, const hc::gaze::FollowerOptions& options, double distance)
      : eyes_(std::move(eyes)), distance_(distance), follower_(options) {}

  /// Takes cameras, and how they sit on the head, as measured.
  /// Errors: Malformed (of `head`, see hc::gaze::HeadCalibration::of).
  hc::Status calibrate(const hc::vision::StereoCalibration& cameras);
  void calibrate(const hc::gaze::HeadCalibration& calibration) { eyes_.calibrate(calibration); }

  /// The frame in which a target is seen: the head's of an eye or its image, else its own.
  [[nodiscard]] static std::int32_t frame_of(std::int32_t coord);
  /// A target: x, y in an image [px], or its place in a frame [m].
  /// @param T_robot_frame  of frame_of(coord), then.
  void see(std::int64_t time, std::int32_t coord, const Eigen::Vector3d& p,
           const Eigen::Isometry3d& T_robot_frame);
  /// Angles to take, as of a target.
  void set(std::int64_t time, const hc::gaze::Angles& setpoint) {
    follower_.see(hc::seconds(time), setpoint);
  }

  /// The target, by all that was seen [s].
  [[nodiscard]] const hc::gaze::Follower& follower() const { return follower_; }

 private:
  /// In the head [m].
  std::optional<Eigen::Vector3d> place(std::int64_t time, hc::gaze::Side side,
                                       Eigen::Vector2d pixel);

  hc::gaze::Eyes eyes_;
  double distance_;
  hc::gaze::Follower follower_;
  std::optional<hc::vision::StereoCalibration> cameras_;
  hc::gaze::Binocular binocular_;
};
