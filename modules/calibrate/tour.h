// SPDX-License-Identifier: Apache-2.0
#pragma once
// The poses that the head takes to be calibrated, and a view of each. Pure.

#include <chrono>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/base/time.h>

#include "calibrate.h"

class Tour {
 public:
  /// @param turn  how far the head turns to each side [rad].
  explicit Tour(double turn)
      : poses_{{0, 0},
               {turn, 0},
               {-turn, 0},
               {0, turn},
               {0, -turn},
               {turn / 2, turn / 2},
               {-turn / 2, -turn / 2},
               {turn / 2, -turn / 2},
               {-turn / 2, turn / 2}} {}

  /// The pose to take next; not once it is complete.
  [[nodiscard]] const hc::gaze::Angles& next() const { return poses_[views_.size()]; }
  [[nodiscard]] const hc::gaze::Angles& last() const { return poses_.back(); }
  [[nodiscard]] bool is_complete() const { return views_.size() == poses_.size(); }

  /// Whether the head, measured at a time, has come to rest at the next pose.
  bool rests(hc::Time time, const hc::gaze::Angles& measured) {
    const bool is_there = std::abs(measured.pan - next().pan) < kNear &&
                          std::abs(measured.tilt - next().tilt) < kNear;
    if (!is_there)
      rests_from_.reset();
    else if (!rests_from_)
      rests_from_ = time;
    return is_there && time - *rests_from_ >= kRests;
  }
  /// Takes the view of the next pose. Errors: Malformed (its images are of another size).
  hc::Status add(HeadView view) {
    if (view.first.size() != view.second.size() ||
        (!views_.empty() && view.first.size() != views_[0].first.size()))
      return hc::Error{hc::Code::Malformed, "the images have different sizes"};
    views_.push_back(std::move(view));
    rests_from_.reset();
    return {};
  }
  /// Gives the views away, and begins again.
  std::vector<HeadView> restart() {
    rests_from_.reset();
    return std::exchange(views_, {});
  }

 private:
  static constexpr double kNear = 0.004;                   // tolerance of a pose [rad]
  static constexpr std::chrono::milliseconds kRests{300};  // time in tolerance until at rest

  const std::vector<hc::gaze::Angles> poses_;
  std::vector<HeadView> views_;
  std::optional<hc::Time> rests_from_;  // none: moving
};
