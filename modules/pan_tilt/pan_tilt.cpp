// SPDX-License-Identifier: Apache-2.0
#include "pan_tilt.h"

#include <cmath>
#include <numbers>

#include <hc/base/format.h>

PanTilt::PanTilt(hc::Module& module) : module_(module) {
  module.on_start([this] { pass(); });
  module.every(hc::pan_tilt::Neck::kTick, [this] { pass(); });
  module.every(parameters_.rate, [this] { neck_.look(); });
  module.on_readable([this] { return neck_.descriptor(); }, [this] { read(); });
  module.on(device_input_, [this](const auto& name) { neck_.set_device(name.text()); });
  module.on(command_, [this](const auto& message) { turn(message); });
}

void PanTilt::pass() {
  neck_.set_focus(module_.focus());
  neck_.pass(parameters_.settings());
}

void PanTilt::read() {
  neck_.set_focus(module_.focus());
  neck_.read();
}

void PanTilt::turn(const hc::MessageOf<hc::RotationKind<double>>& message) {
  neck_.set_focus(module_.focus());
  const auto angles = message.numbers();
  for (const double angle : angles.subspan(1))
    if (std::abs(angle) > 2 * std::numbers::pi)
      throw hc::BadMessage(
          hc::format("{} rad is more than a turn; tilt and pan are in rad, not in degrees", angle));
  const auto& header = message.header;
  neck_.command(module_.now(), {angles[2], angles[1], header.time, header.mode, header.src});
}

void PanTilt::send(const hc::pan_tilt::Gaze& seen) {
  const hc::Time time = module_.now() - (clock_.monotonic() - seen.time);
  gaze_.send({0.0, seen.tilt, seen.pan}, time);
  const Eigen::Isometry3d T_robot_head(hc::frames::rotation(0, seen.tilt, seen.pan));
  if (pose_.linked()) pose_.send(hc::numbers_of(T_robot_head), time);
}
