// SPDX-License-Identifier: Apache-2.0
#pragma once
// The frames of the graph as the topics /tf and /tf_static.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <ros/encode.h>
#include <ros/joints.h>

#include "mapping.h"
#include "participant.h"

class Transforms {
 public:
  /// Opens the topics `published.topic` and that with _static, or ends the module.
  Transforms(Participant& participant, const Mapping& published);

  /// Writes the joints that do not move.
  hc::Status write_fixed(const std::vector<hc::ros::Joint>& joints);
  /// Writes the pose of a joint, unless that would exceed the rate.
  hc::Status write(const hc::ros::Joint& joint, hc::MonotonicTime now);

 private:
  double rate_;
  Writer moving_, fixed_;
  hc::ros::Encoder encoder_;
  std::map<std::string, RateLimit> limits_;  // by child
};
