// SPDX-License-Identifier: Apache-2.0
#pragma once
// The eyes: render images as the cameras would take them, and send them with a camera's latency.

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include <graphics/renderer.h>
#include <hc/module/module.h>

#include <room/sensor.h>
#include "parameters.h"

/// The scene of a pair of images.
struct View {
  hc::Time time;
  std::int64_t number;  ///< of the pair
  Eigen::Isometry3d T_world_head;
  const std::vector<hc::graphics::Item>& items;
  hc::graphics::Light light;  ///< at exposure 1
};

class Eyes {
 public:
  using Kind = decltype(hc::rgb_image());
  using Output = hc::Output<Kind>;

  /// @param parameters, renderer  must outlive it.
  Eyes(const Parameters& parameters, const hc::room::Head& head, hc::graphics::Renderer& renderer,
       Output left, Output right);

  /// Takes a pair. An image without a link is not rendered, which saves most of the work.
  ///
  /// @param[out] depth  of the left image, (H, W) f32 [m], 0 for background; may be null.
  void take(const View& view, cv::Mat* depth);
  /// Sends the images that are due.
  void send_due(hc::Time now);
  /// Whether all images have been sent.
  [[nodiscard]] bool empty() const { return late_.empty(); }

 private:
  struct Eye {
    Output output;
    hc::room::Sensor sensor;
  };
  struct Image {
    Output output;
    hc::DraftOf<Kind> draft;
  };
  void take(Eye& eye, const Eigen::Isometry3d& T_head_eye, const View& view, cv::Mat* depth);

  const Parameters& parameters_;
  hc::graphics::Renderer& renderer_;
  const hc::room::Head head_;
  const hc::graphics::PinholeCamera camera_;
  Eye left_, right_;
  std::deque<std::pair<hc::Time, Image>> late_;  // images and when to send them
};
