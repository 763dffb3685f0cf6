// SPDX-License-Identifier: Apache-2.0
#include <ros/joints.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include <frames/messages.h>

namespace hc::ros {
namespace {

Joint joint(std::string parent, std::string child, const Eigen::Isometry3d& T, hc::Time time) {
  const hc::frames::Pose pose(T);
  return {std::move(parent),
          std::move(child),
          {pose.p.x(), pose.p.y(), pose.p.z()},
          {pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()},
          time};
}

}  // namespace

Result<GraphJoints> GraphJoints::read(const std::string& text) {
  auto frames = HC_TRY(hc::frames::read_frames(text));
  GraphJoints joints{std::move(frames), {}, {}, {}};
  std::map<std::string, std::string> parents;
  std::istringstream entries(text);
  for (std::string entry; std::getline(entries, entry, ';');) {
    std::istringstream words(entry);
    std::string child, parent;
    std::int32_t number = 0;
    if (!(words >> child >> number >> parent)) continue;
    parents[child] = joints.root = parent;
    if (number != 0) joints.names[number] = child;
    const bool moves = std::ranges::find(joints.frames.movers, child, &hc::frames::Mover::child) !=
                       joints.frames.movers.end();
    if (moves) continue;
    auto T =
        HC_TRY(joints.frames.tree.lookup(std::string_view(parent), std::string_view(child), {}));
    joints.fixed.push_back(joint(parent, child, T, {}));
  }
  while (parents.contains(joints.root)) joints.root = parents[joints.root];
  return joints;
}

bool GraphJoints::are_moved_by(std::string_view output) const {
  return std::ranges::any_of(frames.movers,
                             [&](const auto& mover) { return mover.output == output; });
}

Result<Joint> GraphJoints::joint_of(const Message& pose) const {
  auto mover = HC_TRY(frames.mover_of(pose.header.src, pose.header.coord));
  auto T = HC_TRY(rigid_of(pose));
  return joint(mover->parent, mover->child, T, pose.header.time);
}

}  // namespace hc::ros
