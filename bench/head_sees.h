// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the benchmarks of sight share: what the eyes of the simulated head see.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include <graphics/camera.h>
#include <graphics/renderer.h>
#include <room/head.h>
#include <room/sensor.h>
#include <room/world.h>
#include <opencv2/core.hpp>

#include "measure.h"

namespace bench {

inline const double kBaseline = [] {  // of the simulated head [m]
  const auto head = hc::room::Head::nominal();
  return (head.left_eye.translation() - head.right_eye.translation()).norm();
}();
inline const hc::graphics::PinholeCamera kCamera;  // either eye's

inline std::unique_ptr<hc::graphics::Renderer> make_renderer() {
  return must(hc::graphics::Renderer::make());
}

/// What an eye sees, and how it is.
struct Eye {
  Eigen::Isometry3d T_world_eye = Eigen::Isometry3d::Identity();  ///< optical
  cv::Mat image;                                                  ///< (H, W, 3) u8
  cv::Mat truth;                                                  ///< depth (H, W) f32 [m]
};

/// Where the head looks [rad], and the seeds of its cameras' noise.
struct Gaze {
  double pan = 0, tilt = 0;
  std::array<std::uint64_t, 2> seeds = {0, 1};  ///< of the left and the right camera
  std::uint64_t image = 1;                      ///< its number, for the noise
};

/// Both eyes' images of a room, with a camera's noise of 2 of 255; the left one first.
inline std::array<Eye, 2> look(hc::graphics::Renderer& renderer, hc::room::World& world,
                               const Eigen::Vector3d& ball, const Gaze& gaze) {
  std::array<Eye, 2> eyes;
  const auto head = hc::room::Head::nominal();
  const Eigen::Isometry3d T_world_head = hc::room::head_pose(gaze.pan, gaze.tilt);
  const auto& items = world.items(ball);
  for (const std::size_t i : {0U, 1U}) {
    Eye& eye = eyes.at(i);
    eye.T_world_eye = T_world_head * (i == 0 ? head.left_eye : head.right_eye);
    must(renderer.draw(items, kCamera, eye.T_world_eye, world.light(), eye.image, &eye.truth));
    hc::room::Sensor(gaze.seeds.at(i)).apply(eye.image, 0, 2, gaze.image);
  }
  return eyes;
}

}  // namespace bench
