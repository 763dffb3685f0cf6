// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the head has to stand for what was seen, by how it stood then. No messages.

#include <cstdint>
#include <deque>
#include <optional>

#include <frames/track.h>
#include <gaze/binocular.h>
#include <gaze/follower.h>
#include <vision/calibration.h>

/// Coordinate systems of targets (spec/mtp-1.md, R44).
inline constexpr std::int32_t kRobot = 2, kHead = 3, kLeftImage = 7, kRightImage = 8;

double seconds(std::int64_t time);  ///< [ns] in [s]

/// Times are in nanoseconds since any one origin.
class Targets {
 public:
  /// @param distance  of a target that one eye alone has seen [m].
  Targets(const hc::gaze::Eyes& eyes, const hc::gaze::FollowerOptions& options, double distance)
      : eyes_(eyes), distance_(distance), follower_(options) {}

  /// Takes the eyes to be as they were measured.
  /// Errors: Malformed (of `head`, see hc::gaze::HeadCalibration::of).
  hc::Status know(const hc::vision::StereoCalibration& cameras);
  void know(const hc::gaze::HeadCalibration& calibration) { eyes_.calibration = calibration; }

  /// How the head stood at a time. Reports come in the order of time, but where a clock was set
  /// back; then what was known before is forgotten.
  void report(std::int64_t time, const Eigen::Quaterniond& R_robot_head);
  /// How it stood at a time, as far as it is known.
  [[nodiscard]] Eigen::Quaterniond R_robot_head(std::int64_t time) const;

  /// Whether a place in a coordinate system can be looked at.
  static bool can_see(std::int32_t coord);
  /// A target: x, y in a picture [px], or its place [m].
  /// @param coord  one that can_see().
  void see(std::int64_t time, std::int32_t coord, const Eigen::Vector3d& p);
  /// Angles that are wished, as of a target.
  void wish(std::int64_t time, const hc::gaze::Angles& angles) {
    follower_.see(seconds(time), angles);
  }
  /// Takes in the targets that were seen when it is known by now how the head stood.
  void take_in(std::int64_t now);

  /// The target, by all that was taken in [s].
  [[nodiscard]] const hc::gaze::Follower& follower() const { return follower_; }

 private:
  struct Seen {
    std::int64_t time;
    std::int32_t coord;
    Eigen::Vector3d p;
  };
  void take_in(const Seen& seen);

  hc::gaze::Eyes eyes_;
  double distance_;
  hc::gaze::Follower follower_;
  std::optional<hc::vision::StereoCalibration> cameras_;
  hc::gaze::Binocular binocular_;
  hc::frames::Track gazes_{hc::frames::Memory{}};
  std::deque<Seen> waiting_;
};
