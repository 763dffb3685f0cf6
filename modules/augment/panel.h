// SPDX-License-Identifier: Apache-2.0
#pragma once
// The instruments of a robot, with what they show. Knows no ports.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include <frames/module_frames.h>
#include <opencv2/core.hpp>

#include "instruments.h"
#include "pair.h"
#include "scene.h"

class Panel {
 public:
  /// What the gaze follows.
  struct Target {
    std::int64_t time = 0;   ///< [ns]
    std::int32_t coord = 0;  ///< of an image: x, y [px]; of a frame: x, y, z [m]
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
  };
  static constexpr std::int64_t kTargetLives = 500'000'000;  ///< it is shown for so long [ns]

  Instruments shown;
  std::map<std::int32_t, std::string> modes;  ///< their names
  std::int32_t focus = 0;                     ///< the mode in focus, 0: none
  std::optional<Target> target;
  cv::Mat confidence;                   ///< (H, W) u8 of the latest depth; empty: unknown
  double cursor_x = -1, cursor_y = -1;  ///< [px]; -1: the middle

  /// Draws the instruments over an eye's image. @param depth  (H, W) f32 of the left one [m].
  void draw(const Sight& sight, std::size_t eye, const Scene& scene, hc::ModuleFrames& frames,
            const cv::Mat& depth, cv::Mat& image) const;

 private:
  void draw_frames(const Sight& sight, std::size_t eye, const Scene& scene,
                   hc::ModuleFrames& frames, cv::Mat& image) const;
  void draw_target(const Sight& sight, std::size_t eye, hc::ModuleFrames& frames,
                   cv::Mat& image) const;
  void draw_cursor(const cv::Mat& depth, cv::Mat& image) const;
  void draw_task(cv::Mat& image) const;
};
