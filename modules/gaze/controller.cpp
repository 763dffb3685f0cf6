// SPDX-License-Identifier: Apache-2.0
#include "controller.h"

using hc::gaze::Angles;

Angles Controller::command(const hc::gaze::Motion& motion) const {
  return parameters_.within_limits({motion.angles.pan + parameters_.lead(motion.pan_rate),
                                    motion.angles.tilt + parameters_.lead(motion.tilt_rate)});
}

std::optional<Angles> Controller::follow(hc::Time now, const Angles& measured) const {
  const auto& follower = targets.follower();
  if (!is_fresh(follower.last(), now))
    return *parameters_.idle_salience > 0 ? std::optional(parameters_.within_limits({0, 0}))
                                          : std::nullopt;
  const auto motion = *follower.at(hc::seconds(now.time_since_epoch()) + *parameters_.predict);
  if (hc::gaze::between(motion.angles, measured) < *parameters_.dead_zone) return std::nullopt;
  return command(motion);
}

void Controller::push(hc::Time now, double left, double down, const Angles& measured) {
  const double full = *parameters_.stick_rate;
  stick_.push({std::clamp(left, -1.0, 1.0) * full, std::clamp(down, -1.0, 1.0) * full},
              hc::seconds(now.time_since_epoch()), measured);
}

std::optional<Angles> Controller::steer(hc::Time now, const Angles& measured) {
  constexpr double kLead = 0.02;  // to start at once, and to bridge a late push [s]
  auto motion = stick_.at(hc::seconds(now.time_since_epoch()), measured);
  if (!motion) return std::nullopt;
  motion->angles.pan += motion->pan_rate * kLead;
  motion->angles.tilt += motion->tilt_rate * kLead;
  return command(*motion);
}

bool Controller::wants_head(hc::Time now) const {
  return is_fresh(targets.follower().last(), now) || is_fresh(stick_.last(), now);
}
