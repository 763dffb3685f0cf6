// SPDX-License-Identifier: Apache-2.0
#pragma once
// The instruments and the data they display. No ports.

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
  /// Target of the gaze.
  struct Target {
    hc::Time time;
    std::int32_t coord = 0;  ///< an image: p is x, y [px]; a frame: x, y, z [m]
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
  };
  static constexpr std::chrono::milliseconds kTargetLives{500};  ///< how long a target is shown

  Instruments shown;
  std::map<std::int32_t, std::string> modes;  ///< names of modes
  std::int32_t focus = 0;                     ///< mode in focus, 0: none
  std::optional<Target> target;
  cv::Mat confidence;                   ///< (H, W) u8 of the latest depth; empty: unknown
  double cursor_x = -1, cursor_y = -1;  ///< [px]; -1: the centre

  /// Draws the instruments over an eye's image. @param depth  (H, W) f32 of the left image [m].
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
