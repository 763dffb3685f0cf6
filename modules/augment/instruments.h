// SPDX-License-Identifier: Apache-2.0
#pragma once
// Virtual instruments: lines and words over an image that show what the robot perceives and does.
// Images are (H, W, 3) u8, red, green, blue. Pure.

#include <string>
#include <string_view>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <graphics/camera.h>
#include <hc/base/result.h>

/// Which are shown.
struct Instruments {
  bool gaze = false;        ///< the target that the gaze follows
  bool frames = false;      ///< axes of frames
  bool depth = false;       ///< depth under the cursor
  bool confidence = false;  ///< how sure that depth is
  bool task = false;        ///< the task in focus

  [[nodiscard]] bool any() const { return gaze || frames || depth || confidence || task; }
};

/// Reads "gaze depth", with blanks or commas between the names of Instruments' members.
/// Errors: Invalid (a word that is none).
hc::Result<Instruments> read_instruments(const std::string& text);

/// A ring with its name, around a pixel.
void draw_ring(cv::Mat& image, const Eigen::Vector2d& pixel, const std::string& name);
/// A cross with words beside it, on a pixel.
void draw_cross(cv::Mat& image, const Eigen::Vector2d& pixel, const std::string& words);
/// The axes of a frame, x red, y green, z blue, and its name; nothing where it is not before the
/// camera. @param length  [m]
void draw_axes(cv::Mat& image, const hc::graphics::PinholeCamera& camera,
               const Eigen::Isometry3d& T_camera_frame, const std::string& name,
               double length = 0.15);
/// A line of words in the top left corner.
void draw_title(cv::Mat& image, const std::string& words);
