// SPDX-License-Identifier: Apache-2.0
#pragma once
// Virtual instruments: lines and text over an image that show the robot's perception and actions.
// Images are (H, W, 3) u8, red, green, blue. Pure.

#include <string>
#include <string_view>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <graphics/camera.h>
#include <hc/base/result.h>

/// The instruments shown.
struct Instruments {
  bool gaze = false;        ///< target of the gaze
  bool frames = false;      ///< axes of frames
  bool depth = false;       ///< depth under the cursor
  bool confidence = false;  ///< confidence of that depth
  bool task = false;        ///< task in focus

  [[nodiscard]] bool any() const { return gaze || frames || depth || confidence || task; }
};

/// Reads "gaze depth": member names of Instruments, separated by blanks or commas.
/// Errors: Invalid (unknown name).
hc::Result<Instruments> read_instruments(const std::string& text);

/// A labelled ring around a pixel.
void draw_ring(cv::Mat& image, const Eigen::Vector2d& pixel, const std::string& name);
/// A labelled cross on a pixel.
void draw_cross(cv::Mat& image, const Eigen::Vector2d& pixel, const std::string& words);
/// The axes of a frame, x red, y green, z blue, and its name; nothing if they are behind the
/// camera. @param length  [m]
void draw_axes(cv::Mat& image, const hc::graphics::PinholeCamera& camera,
               const Eigen::Isometry3d& T_camera_frame, const std::string& name,
               double length = 0.15);
/// A line of text in the top left corner.
void draw_title(cv::Mat& image, const std::string& words);
