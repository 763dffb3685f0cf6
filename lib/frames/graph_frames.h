// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the frames of a graph file, which `hc run` passes to modules (spec/graph.md, G31). Pure.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <frames/tree.h>

namespace hc::frames {

/// The source of a moving frame's pose.
struct Mover {
  std::string parent, child;  ///< the joint
  std::string output;         ///< "MODULE.PORT"
  std::int32_t source = 0;    ///< src of its messages; 0: unknown
  std::int32_t coord = 0;     ///< 1000 · parent + child (R44); 0: one of them has no number
};

/// A graph's frames. `hc::feed()` (frames/messages.h) feeds them with messages.
struct GraphFrames {
  Tree tree;
  std::vector<Mover> movers;  ///< in the order of the text

  /// The mover of a message: the one with its coord, unless its src belongs to another mover; else
  /// the one without a coord that has its src. Forwarded messages keep their original src, so an
  /// unknown src does not matter.
  ///
  /// Errors: NotFound ("frames: no frame is moved by messages from 12 with coord 2003").
  [[nodiscard]] Result<const Mover*> mover_of(std::int32_t source, std::int32_t coord) const;
};

/// Maximum number of frames.
inline constexpr std::size_t kMostFrames = 1000;

/// Reads the text of a module's parameter `frames`: frames separated by `;`, each a list of words.
///
///     head 3 robot neck.pose 11; left_eye 4 head 0 0.03 0 0 0 0 1
///
/// An empty text is an empty tree. A parent without an entry is the root; it has a number if it is
/// one of kStandardFrames.
///
/// @param memory  of each moving joint.
///
/// Errors: Malformed, TooLarge, Invalid (as Tree), with the frame: "frames: frame 2, left_eye: …".
Result<GraphFrames> read_frames(std::string_view text, const Memory& memory = {});

}  // namespace hc::frames
