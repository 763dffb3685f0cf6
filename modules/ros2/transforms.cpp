// SPDX-License-Identifier: Apache-2.0
#include "transforms.h"

#include <span>

#include <hc/module/module.h>

#include "publication.h"

Transforms::Transforms(Participant& participant, const Mapping& published)
    : rate_(published.rate),
      moving_(hc::value_or_end(participant.write(published.topic, hc::ros::Type::TfMessage,
                                                 qos_of(published, hc::ros::Type::TfMessage)))),
      fixed_(
          hc::value_or_end(participant.write(published.topic + "_static", hc::ros::Type::TfMessage,
                                             {.transient_local = true, .depth = 1}))) {}

hc::Status Transforms::write_fixed(const std::vector<hc::ros::Joint>& joints) {
  if (joints.empty()) return {};
  return fixed_.write(encoder_.encode(joints));
}

hc::Status Transforms::write(const hc::ros::Joint& joint, hc::MonotonicTime now) {
  if (!limits_.try_emplace(joint.child, rate_).first->second.passes(now)) return {};
  return moving_.write(encoder_.encode(std::span(&joint, 1)));
}
