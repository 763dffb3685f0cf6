// SPDX-License-Identifier: Apache-2.0
// Turns the head to where a task wants it to look, and bids for the head while it wants that.
#include <algorithm>
#include <cmath>
#include <optional>

#include <frames/messages.h>
#include <gaze/stick.h>
#include <hc/module/module.h>

#include "parameters.h"
#include "targets.h"

namespace {

using hc::gaze::Angles;

constexpr std::int32_t kGaze = 13;

/// How often a push is said again: the first time may come before the head is given to who pushes.
constexpr std::chrono::milliseconds kSteer{5};

/// A target may be so far in the future, by another clock [ns].
constexpr std::int64_t kAhead = 200'000'000;

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"gaze",
                    "Turns the head to a target, and bids for the head while there is one."};
  auto target =
      module.input("target", hc::position<double>(),
                   "what is to be looked at: x, y in the left picture (7) or the right "
                   "one (8) [px], or its place in the robot's frame (2) or the head's (3) [m]");
  auto wish = module.input("wish", hc::rotation<double>(), "roll, tilt, pan to take [rad]");
  auto stick = module.input("stick", hc::table<double>(),
                            "1 x 2: turn to the left, turn down, -1 … 1 of stick_rate");
  auto report = module.input("gaze", hc::rotation<double>().in(kGaze), "how the head stands");
  auto calibration =
      module.input("calibration", hc::table<double>(), "how the eyes sit: calibrate's result");
  auto command = module.output("command", hc::rotation<double>().in(kGaze),
                               "roll 0, tilt, pan that the head is to take [rad]");
  auto bid = module.output("bid", hc::table<double>(),
                           "salience while there is a target, else that of rest");

  const Parameters parameters{module};

  std::optional<Targets> targets;
  hc::gaze::Stick steering;
  bool was_wanted = false;  // as it was bid last
  bool was_ahead = false;   // the last target's time was in the future

  module.on_start([&] {
    targets.emplace(parameters.eyes(), parameters.follower(), *parameters.distance);
    const auto& file = *parameters.calibration_file;
    if (file.empty()) return;
    const auto cameras = hc::value_or_end(hc::vision::read_calibration(file));
    if (auto known = targets->know(cameras); !known) throw hc::ModuleError(known.error());
  });

  auto now = [&] { return seconds(module.now()); };
  auto stands = [&] { return hc::gaze::angles_of(targets->R_robot_head(module.now())); };
  auto send = [&](const Angles& to) {
    const auto [pan, tilt] = parameters.within_limits(to);
    auto draft = command.loan(1, 1);
    draft.header.time = module.now();
    auto numbers = draft.matrix().numbers();
    numbers[0] = 0;
    numbers[1] = tilt;
    numbers[2] = pan;
    command.send(std::move(draft));
  };
  /// Sends the head to where something is that moves, so that it stands there when it gets there.
  auto send_ahead = [&](const hc::gaze::Motion& to) {
    send({to.angles.pan + parameters.lead(to.pan_rate),
          to.angles.tilt + parameters.lead(to.tilt_rate)});
  };
  auto is_fresh = [&](std::optional<double> last) {
    return last && now() - *last <= *parameters.patience;
  };
  /// Sends the head to where the target is when it gets there.
  auto follow = [&] {
    targets->take_in(module.now());
    const auto& follower = targets->follower();
    if (!is_fresh(follower.last())) {
      if (*parameters.rest > 0) send({0, 0});
      return;
    }
    const auto motion = *follower.at(now() + *parameters.predict);
    if (hc::gaze::between(motion.angles, stands()) >= *parameters.dead_zone) send_ahead(motion);
  };

  /// When something was sensed, by the time of its message; nothing of what is to come, since it
  /// would hold back all that is sensed until then.
  auto sensed_at = [&](std::int64_t time) -> std::optional<std::int64_t> {
    if (time <= 0) return module.now();
    const std::int64_t ahead = time - module.now();
    const bool is_ahead = ahead > kAhead;
    if (is_ahead && !was_ahead)
      module.log("left out: a target " + std::to_string(ahead / 1'000'000) +
                 " ms in the future, as others may be");
    was_ahead = is_ahead;
    if (is_ahead) return std::nullopt;
    return time;
  };

  module.on(calibration, [&](const auto& message) {
    auto found = hc::gaze::HeadCalibration::of(message.matrix().numbers());
    if (!found) return module.log("calibration: " + found.error().detail);
    targets->know(*found);
  });
  module.on(report, [&](const auto& message) {
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("gaze: " + q.error().detail);
    if (message.header.time > 0) targets->report(message.header.time, *q);
  });
  module.on(target, [&](const auto& message) {
    if (message.header.empty()) return;
    const auto numbers = message.matrix().numbers();
    const auto time = sensed_at(message.header.time);
    const Eigen::Vector3d p(numbers[0], numbers[1], numbers[2]);
    if (!time || !p.allFinite()) return;
    const std::int32_t coord = message.header.coord;
    if (!Targets::can_see(coord))
      throw hc::ModuleError("target: coordinate system " + std::to_string(coord) +
                            " is none of 2, 3, 7, 8");
    targets->see(*time, coord, p);
    follow();
  });
  module.on(wish, [&](const auto& message) {
    const auto q = hc::rotation_of(message);
    if (!q) return module.log("wish: " + q.error().detail);
    const auto time = sensed_at(message.header.time);
    if (!time) return;
    targets->wish(*time, hc::gaze::angles_of(*q));
    follow();
  });
  /// Whether it wants the head.
  auto wants = [&] { return is_fresh(targets->follower().last()) || is_fresh(steering.last()); };
  auto tell_bid = [&] {
    was_wanted = wants();
    auto message = hc::table({was_wanted ? *parameters.salience : *parameters.rest});
    message.header.time = module.now();
    bid.send(message);
  };
  /// Sends the head on while a stick is pushed and told of.
  auto steer = [&] {
    constexpr double kLead = 0.02;  // so that it moves at once, and on if one comes late [s]
    auto motion = steering.at(now(), stands());
    if (!motion) return;
    motion->angles.pan += motion->pan_rate * kLead;
    motion->angles.tilt += motion->tilt_rate * kLead;
    send_ahead(*motion);
  };
  module.on(stick, [&](const auto& message) {
    const auto numbers = message.matrix().numbers();
    if (numbers.size() < 2 || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1])) return;
    const double full = *parameters.stick_rate;
    steering.push(
        {std::clamp(numbers[0], -1.0, 1.0) * full, std::clamp(numbers[1], -1.0, 1.0) * full}, now(),
        stands());
    // Who pushes does not wait for the next bid.
    if (!was_wanted && wants()) tell_bid();
    steer();
  });

  module.every(parameters.rate, follow);
  module.every(kSteer, steer);
  module.every(std::chrono::milliseconds(100), tell_bid);
  return module.run(argc, argv);
}
