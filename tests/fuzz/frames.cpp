// SPDX-License-Identifier: Apache-2.0
// Any text: the frames of a graph, each of which is joined to the root, or one line.
#include <frames/graph_frames.h>

int fuzz_frames(const std::uint8_t* data, std::size_t size) {
  auto frames = hc::frames::read_frames({reinterpret_cast<const char*>(data), size});
  if (!frames) {
    HC_CHECK(frames.error().detail.starts_with("frames: "), frames.error().detail);
    HC_CHECK(frames.error().detail.find('\n') == std::string::npos, frames.error().detail);
    return 0;
  }
  for (const auto& mover : frames->movers) {
    auto& tree = frames->tree;
    constexpr auto kTime = hc::unix_time(1);
    HC_CHECK(!tree.lookup(mover.parent, mover.child, kTime), mover.child);
    HC_CHECK(
        tree.feed(mover.parent, mover.child, kTime, Eigen::Isometry3d::Identity()).has_value());
    HC_CHECK(tree.lookup(mover.child, mover.parent, kTime).has_value(), mover.child);
  }
  return 0;
}
