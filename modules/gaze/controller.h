// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands the head to follow a target or a stick. No messages.

#include <cmath>
#include <optional>

#include <gaze/stick.h>

#include "parameters.h"
#include "targets.h"

class Controller {
 public:
  /// @param parameters  must outlive it.
  Controller(const GazeParameters& parameters, Targets empty)
      : targets(std::move(empty)), parameters_(parameters) {}

  /// The command that follows the target: to its predicted position when the head arrives. Nothing
  /// if there is no target, or it is within the dead zone around `measured`.
  [[nodiscard]] std::optional<hc::gaze::Angles> follow(hc::Time now,
                                                       const hc::gaze::Angles& measured) const;
  /// Takes a position of the stick. @param left, down  -1 … 1.
  void push(hc::Time now, double left, double down, const hc::gaze::Angles& measured);
  /// The command that follows the stick; nothing while it is centred.
  [[nodiscard]] std::optional<hc::gaze::Angles> steer(hc::Time now,
                                                      const hc::gaze::Angles& measured);
  /// Whether there is a fresh target or a deflected stick.
  [[nodiscard]] bool wants_head(hc::Time now) const;

  Targets targets;

 private:
  [[nodiscard]] bool is_fresh(std::optional<double> last, hc::Time now) const {
    return last && std::abs(hc::seconds(now.time_since_epoch()) - *last) <= *parameters_.timeout;
  }
  /// The command for a moving target: ahead of it by the unit's braking distance, within its
  /// limits.
  [[nodiscard]] hc::gaze::Angles command(const hc::gaze::Motion& motion) const;

  const GazeParameters& parameters_;
  hc::gaze::Stick stick_;
};
