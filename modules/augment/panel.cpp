// SPDX-License-Identifier: Apache-2.0
#include "panel.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <hc/base/format.h>

namespace {

using hc::Coord;

/// A cursor coordinate, limited to the image; the centre if negative.
int within(double at, int size) {
  return std::min(static_cast<int>(at < 0 ? (size - 1) / 2.0 : at), size - 1);
}

}  // namespace

void Panel::draw(const Sight& sight, std::size_t eye, const Scene& scene, hc::ModuleFrames& frames,
                 const cv::Mat& depth, cv::Mat& image) const {
  if (shown.frames) draw_frames(sight, eye, scene, frames, image);
  if (shown.gaze) draw_target(sight, eye, frames, image);
  if (eye == 0 && (shown.depth || shown.confidence)) draw_cursor(depth, image);
  if (shown.task) draw_task(image);
}

void Panel::draw_frames(const Sight& sight, std::size_t eye, const Scene& scene,
                        hc::ModuleFrames& frames, cv::Mat& image) const {
  const Eigen::Isometry3d T_eye_world = sight.T_world_eye.at(eye).inverse();
  for (const auto& name : frames.tree().names()) {
    const auto T_world_frame = frames.tree().nearest("world", std::string_view(name), sight.time);
    if (T_world_frame) draw_axes(image, sight.camera, T_eye_world * *T_world_frame, name);
  }
  for (const auto& body : scene.bodies())
    draw_axes(image, sight.camera, T_eye_world * body.T_world_body, "");
}

void Panel::draw_target(const Sight& sight, std::size_t eye, hc::ModuleFrames& frames,
                        cv::Mat& image) const {
  if (!target || std::chrono::abs(sight.time - target->time) > kTargetLives) return;
  const auto coord = target->coord;
  const bool is_left = coord == Coord::kLeftImage || coord == Coord::kLeftRectified;
  const bool is_right = coord == Coord::kRightImage || coord == Coord::kRightRectified;
  if (is_left || is_right) {
    if (is_left == (eye == 0)) draw_ring(image, target->p.head<2>(), "gaze");
    return;
  }
  const auto T_world_frame = frames.tree().nearest("world", coord, sight.time);
  if (!T_world_frame) return;
  const Eigen::Vector3d p = sight.in_eye(eye, *T_world_frame * target->p);
  if (p.z() > sight.camera.near) draw_ring(image, sight.camera.project(p), "gaze");
}

void Panel::draw_cursor(const cv::Mat& depth, cv::Mat& image) const {
  const cv::Point at(within(cursor_x, image.cols), within(cursor_y, image.rows));
  std::string words;
  if (shown.depth) {
    const double metres = depth.at<float>(at);
    words = metres > 0 ? hc::format("{:.2f} m", metres) : "unknown";
  }
  if (shown.confidence && confidence.size() == image.size())
    words += hc::format(" sure {:.0f} %", 100 * confidence.at<std::uint8_t>(at) / 255.0);
  draw_cross(image, {at.x, at.y}, words);
}

void Panel::draw_task(cv::Mat& image) const {
  const auto name = modes.find(focus);
  draw_title(image, "task: " + (name != modes.end() ? name->second
                                : focus == 0        ? std::string("none")
                                                    : std::to_string(focus)));
}
