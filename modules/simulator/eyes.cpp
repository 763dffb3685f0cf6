// SPDX-License-Identifier: Apache-2.0
#include "eyes.h"

#include <vision/messages.h>

Eyes::Eyes(const Parameters& parameters, const hc::room::Head& head,
           hc::graphics::Renderer& renderer, Output left, Output right)
    : parameters_(parameters),
      renderer_(renderer),
      head_(head),
      camera_(parameters.camera()),
      left_{std::move(left), hc::room::Sensor(2 * parameters.world_seed())},
      right_{std::move(right), hc::room::Sensor(2 * parameters.world_seed() + 1)} {}

void Eyes::take(const View& view, cv::Mat* depth) {
  auto first = head_.left_eye, second = head_.right_eye;
  if (*parameters_.swapped) std::swap(first, second);
  take(left_, first, view, depth);
  take(right_, second, view, nullptr);
}

void Eyes::take(Eye& eye, const Eigen::Isometry3d& T_head_eye, const View& view, cv::Mat* depth) {
  if (!eye.output.linked() && depth == nullptr) return;
  auto draft = eye.output.loan(camera_.height, camera_.width);
  draft.header.time = view.time;
  cv::Mat rgb = hc::as_mat(draft);
  auto light = view.light;
  light.exposure = static_cast<float>(*parameters_.exposure);
  const Eigen::Isometry3d T_world_eye = view.T_world_head * T_head_eye;
  hc::succeed_or_end(renderer_.draw(view.items, camera_, T_world_eye, light, rgb, depth));
  eye.sensor.apply(rgb, *parameters_.blur, *parameters_.noise,
                   static_cast<std::uint64_t>(view.number));
  late_.emplace_back(view.time + hc::duration(*parameters_.latency),
                     Image{eye.output, std::move(draft)});
}

void Eyes::send_due(hc::Time now) {
  for (; !late_.empty() && late_.front().first <= now; late_.pop_front())
    late_.front().second.output.send(std::move(late_.front().second.draft));
}
