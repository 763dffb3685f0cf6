// SPDX-License-Identifier: Apache-2.0
#pragma once
// An ideal neck in the time of messages: the head takes each pose a fixed delay after the pose's
// time, and it is known until when all poses have arrived (doc/decisions/009-simulation-time.md).
// Pure.

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <hc/base/time.h>

class Neck {
 public:
  struct Pose {
    hc::Time time;  ///< when the head takes it
    Eigen::Quaterniond R_robot_head;
  };

  /// @param delay  over 0. @param start  no pose has an earlier time.
  Neck(std::chrono::nanoseconds delay, hc::Time start) : delay_(delay), newest_(start) {}

  /// Takes in a pose; their times do not decrease.
  void add(hc::Time time, const Eigen::Quaterniond& R_robot_head) {
    newest_ = std::max(newest_, time);
    poses_.push_back({hc::later(time, delay_), R_robot_head});
  }
  /// Whether all poses have arrived that the head takes until a time. A pose of the same time as
  /// the last may follow, so only a later one shows that.
  [[nodiscard]] bool knows(hc::Time time) const { return time - delay_ < newest_; }
  /// The next pose that the head takes until a time, in the order in which they arrived.
  std::optional<Pose> next(hc::Time time) {
    if (poses_.empty() || poses_.front().time > time) return std::nullopt;
    std::optional<Pose> first = poses_.front();
    poses_.pop_front();
    return first;
  }

 private:
  std::chrono::nanoseconds delay_;
  hc::Time newest_;
  std::deque<Pose> poses_;  // not taken yet
};
