// SPDX-License-Identifier: Apache-2.0
#pragma once
// The frames of a graph as joints of ROS. Pure.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <frames/graph_frames.h>
#include <hc/base/result.h>
#include <hc/mtp/message.h>
#include <ros/encode.h>

namespace hc::ros {

struct GraphJoints {
  hc::frames::GraphFrames frames;
  std::map<std::int32_t, std::string> names;  ///< of frames, by number
  std::vector<Joint> fixed;                   ///< joints that do not move
  std::string root;                           ///< the frame without a parent; empty: no frames

  /// @param text  of a module's parameter `frames` (spec/graph.md, G31).
  /// Errors: as frames::read_frames().
  static Result<GraphJoints> read(const std::string& text);

  /// Whether poses of an output, "MODULE.PORT", move any joint.
  [[nodiscard]] bool are_moved_by(std::string_view output) const;

  /// The joint moved by a pose. Errors: as frames::GraphFrames::mover_of() and rigid_of().
  [[nodiscard]] Result<Joint> joint_of(const Message& pose) const;
};

}  // namespace hc::ros
