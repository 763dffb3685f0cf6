// SPDX-License-Identifier: Apache-2.0
#include "instruments.h"

#include <algorithm>
#include <array>
#include <utility>

#include <hc/base/words.h>
#include <opencv2/imgproc.hpp>

namespace {

const cv::Scalar kWhite(255, 255, 255), kBlack(0, 0, 0), kYellow(255, 220, 0);

cv::Point point(const Eigen::Vector2d& pixel) {
  constexpr double kMost = 1e5;  // outside any image
  return {static_cast<int>(std::clamp(pixel.x(), -kMost, kMost)),
          static_cast<int>(std::clamp(pixel.y(), -kMost, kMost))};
}

/// White with a black outline: legible on any image.
void write(cv::Mat& image, const std::string& words, const cv::Point& at) {
  constexpr double kSize = 0.5;
  for (const auto& [colour, thick] : {std::pair{kBlack, 3}, std::pair{kWhite, 1}})
    cv::putText(image, words, at, cv::FONT_HERSHEY_SIMPLEX, kSize, colour, thick, cv::LINE_AA);
}

void draw_line(cv::Mat& image, const cv::Point& from, const cv::Point& to,
               const cv::Scalar& colour) {
  cv::line(image, from, to, colour, 2, cv::LINE_AA);
}

}  // namespace

hc::Result<Instruments> read_instruments(const std::string& text) {
  Instruments shown;
  const std::pair<const char*, bool*> known[] = {{"gaze", &shown.gaze},
                                                 {"frames", &shown.frames},
                                                 {"depth", &shown.depth},
                                                 {"confidence", &shown.confidence},
                                                 {"task", &shown.task}};
  for (const auto word : hc::words_of(text, " ,\t\n")) {
    const auto* found =
        std::ranges::find_if(known, [&](const auto& each) { return word == each.first; });
    if (found == std::end(known))
      return hc::Error{hc::Code::Invalid,
                       "instruments: \"" + std::string(word) +
                           "\" is not one of gaze, frames, depth, confidence, task"};
    *found->second = true;
  }
  return shown;
}

void draw_ring(cv::Mat& image, const Eigen::Vector2d& pixel, const std::string& name) {
  constexpr int kRadius = 16;
  const auto middle = point(pixel);
  cv::circle(image, middle, kRadius, kYellow, 2, cv::LINE_AA);
  write(image, name, middle + cv::Point(kRadius + 4, 5));
}

void draw_cross(cv::Mat& image, const Eigen::Vector2d& pixel, const std::string& words) {
  constexpr int kArm = 8;
  const auto middle = point(pixel);
  draw_line(image, middle - cv::Point(kArm, 0), middle + cv::Point(kArm, 0), kWhite);
  draw_line(image, middle - cv::Point(0, kArm), middle + cv::Point(0, kArm), kWhite);
  write(image, words, middle + cv::Point(kArm + 4, -4));
}

void draw_axes(cv::Mat& image, const hc::graphics::PinholeCamera& camera,
               const Eigen::Isometry3d& T_camera_frame, const std::string& name, double length) {
  const Eigen::Vector3d origin = T_camera_frame.translation();
  const std::array colours = {cv::Scalar(230, 40, 40), cv::Scalar(40, 200, 40),
                              cv::Scalar(60, 90, 255)};
  std::array<Eigen::Vector3d, 3> ends;
  for (int axis = 0; axis < 3; ++axis)
    ends[static_cast<std::size_t>(axis)] = origin + length * T_camera_frame.linear().col(axis);
  const auto is_behind = [&](const auto& p) { return p.z() < camera.near; };
  if (is_behind(origin) || std::ranges::any_of(ends, is_behind)) return;
  const auto from = point(camera.project(origin));
  for (std::size_t axis = 0; axis < 3; ++axis)
    draw_line(image, from, point(camera.project(ends[axis])), colours[axis]);
  write(image, name, from + cv::Point(6, 16));
}

void draw_title(cv::Mat& image, const std::string& words) {
  write(image, words, {10, 22});
}
