// SPDX-License-Identifier: Apache-2.0
#pragma once
// The parameters of `gaze`, and values derived from them.

#include <algorithm>
#include <string>

#include <gaze/eyes.h>
#include <gaze/follower.h>
#include <hc/module/module.h>
#include <vision/module_cameras.h>

struct GazeParameters {
  hc::Module& module;

  hc::Parameter<double> rate =
      module.parameter("rate", 100.0, "Hz", "commands a second", {.min = 1, .max = 1000});
  hc::Parameter<double> salience =
      module.parameter("salience", 0.5, "", "of the bid", {.min = 0, .max = 1});
  hc::Parameter<double> idle_salience = module.parameter(
      "idle_salience", 0.0, "",
      "salience of looking straight ahead while there is no target, 0: idle", {.min = 0, .max = 1});
  hc::Parameter<double> timeout =
      module.parameter("timeout", 0.5, "s", "how long a lost target keeps the head",
                       {.min = 0.01, .max = 60, .fixed = true});
  hc::Parameter<double> noise =
      module.parameter("noise", 0.003, "rad", "measurement noise: σ of the target's angles",
                       {.min = 1e-6, .max = 1, .fixed = true});
  hc::Parameter<double> process_noise = module.parameter(
      "process_noise", 2.0, "rad/s²",
      "process noise: σ of the target's acceleration; larger is faster but noisier",
      {.min = 1e-3, .max = 1e3, .fixed = true});
  hc::Parameter<double> predict = module.parameter(
      "predict", 0.03, "s", "latency from a command to the motion", {.min = 0, .max = 1});
  hc::Parameter<double> horizon =
      module.parameter("horizon", 0.2, "s", "how long to extrapolate a lost target",
                       {.min = 0, .max = 10, .fixed = true});
  hc::Parameter<double> acceleration =
      module.parameter("acceleration", 1.795, "rad/s²",
                       "deceleration of the unit towards a commanded position; 0: infinite",
                       {.min = 0, .max = 1000});
  hc::Parameter<double> base_speed = module.parameter(
      "base_speed", 0.8976, "rad/s", "speed up to which the unit starts and stops at once",
      {.min = 0, .max = 100});
  hc::Parameter<double> dead_zone = module.parameter(
      "dead_zone", 0.0, "rad", "no command for a target within this angle of the gaze",
      {.min = 0, .max = 1});
  hc::Parameter<double> stick_rate = module.parameter(
      "stick_rate", 1.0, "rad/s", "speed of the head at full deflection", {.min = 0.01, .max = 10});
  hc::Parameter<double> pan_max =
      module.parameter("pan_max", 2.77, "rad", "to either side", {.min = 0, .max = 3.2});
  hc::Parameter<double> tilt_max =
      module.parameter("tilt_max", 0.81, "rad", "down", {.min = 0, .max = 1.6});
  hc::Parameter<double> tilt_min =
      module.parameter("tilt_min", -0.54, "rad", "up", {.min = -1.6, .max = 0});
  hc::Parameter<std::string> calibration_file = module.parameter(
      "calibration_file", "", "",
      "file of stereo_calibration and calibrate, instead of focal, cx, cy", {.fixed = true});
  hc::Parameter<double> focal = module.parameter(
      "focal", hc::vision::kUnknownFocal, "px",
      "focal length of the eyes; 0: unknown, as cx and cy: those of the default head are assumed",
      {.min = 0, .max = 1e6, .fixed = true});
  hc::Parameter<double> cx = module.parameter("cx", -1.0, "px", "principal point, -1: unknown",
                                              {.min = -1, .max = 65535, .fixed = true});
  hc::Parameter<double> cy = module.parameter("cy", -1.0, "px", "the same, from the top",
                                              {.min = -1, .max = 65535, .fixed = true});
  hc::Parameter<double> distance =
      module.parameter("distance", 2.5, "m", "assumed of a target seen by one eye alone",
                       {.min = 0.2, .fixed = true});

  /// Whether pixels are known to be of these eyes.
  [[nodiscard]] bool has_camera() const {
    return !calibration_file->empty() ||
           (*focal != hc::vision::kUnknownFocal && *cx >= 0 && *cy >= 0);
  }
  /// Eyes with these intrinsics, or the default head's, and mountings.
  [[nodiscard]] hc::gaze::Eyes eyes(const Eigen::Isometry3d& T_head_left,
                                    const Eigen::Isometry3d& T_head_right) const {
    hc::gaze::Eyes eyes(T_head_left, T_head_right);
    if (*focal != hc::vision::kUnknownFocal) eyes.focal = *focal;
    if (*cx >= 0) eyes.cx = *cx;
    if (*cy >= 0) eyes.cy = *cy;
    return eyes;
  }
  [[nodiscard]] hc::gaze::FollowerOptions follower() const {
    return {*noise, *process_noise, *timeout, *horizon};
  }
  /// How far a command must lead a target that moves at `speed` [rad/s] [rad].
  [[nodiscard]] double lead(double speed) const {
    return *acceleration > 0 ? hc::gaze::braking(speed, {*acceleration, *base_speed}) : 0;
  }
  /// The nearest orientation within the unit's limits.
  [[nodiscard]] hc::gaze::Angles within_limits(const hc::gaze::Angles& to) const {
    return {std::clamp(to.pan, -*pan_max, *pan_max), std::clamp(to.tilt, *tilt_min, *tilt_max)};
  }
};
