// SPDX-License-Identifier: Apache-2.0
#pragma once
// An output of the graph as a ROS topic.

#include <functional>
#include <map>
#include <optional>
#include <string>

#include <client/tap.h>
#include <ros/encode.h>

#include "mapping.h"
#include "participant.h"

/// The QoS of a topic.
Qos qos_of(const Mapping& published, hc::ros::Type type);

class Publication {
 public:
  /// Logs a problem; called on another thread.
  using Log = std::function<void(const std::string& kind, const std::string& line)>;

  /// @param frames  names of frames by number, for frame_ids.
  /// @param participant, log  must outlive the publication.
  Publication(hc::RunningGraph graph, Mapping published, std::map<std::int32_t, std::string> frames,
              Participant& participant, Log log);

 private:
  // On the tap's thread.
  void open();
  void take(const hc::Message& message);

  const hc::RunningGraph graph_;
  const Mapping published_;
  Participant& participant_;
  const Log log_;
  hc::ros::Encoder encoder_;
  RateLimit limit_;
  hc::ros::Type type_ = hc::ros::Type::Float64MultiArray;
  std::optional<Writer> writer_;
  hc::Tap tap_;  // last: its thread uses the above
};
