// SPDX-License-Identifier: Apache-2.0
#pragma once
// The frames of a graph file, as `hc run` passes them to a module (spec/graph.md, G31), as a tree.
// Pure.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <frames/tree.h>

namespace hc::frames {

/// What reports the pose of a frame that moves.
struct Mover {
  std::string parent, child;  ///< the joint
  std::string output;         ///< "MODULE.PORT"
  std::int32_t source = 0;    ///< src of its messages; 0: unknown
  std::int32_t coord = 0;     ///< 1000 · parent + child (R44); 0: one of them has no number
};

/// A graph's frames. `hc::feed()` (frames/messages.h) hands messages to them.
struct GraphFrames {
  Tree tree;
  std::vector<Mover> movers;  ///< in the order of the text

  /// Who is meant by the pose of a message: the one of its coord, unless its src is another
  /// mover's; or else the one without a coord that has its src. What is passed on by others keeps
  /// the src that it began with, so a src that nobody has says nothing.
  ///
  /// Errors: NotFound (none of them: "frames: no frame is moved by messages from 12 with coord
  /// 2003").
  [[nodiscard]] Result<const Mover*> mover_of(std::int32_t source, std::int32_t coord) const;
};

/// Most frames of one text.
inline constexpr std::size_t kMostFrames = 1000;

/// Reads the text of a module's parameter `frames`: frames joined by `;`, each a line of words.
///
///     head 3 robot neck.pose 11; left_eye 4 head 0 0.03 0 0 0 0 1
///
/// An empty text is a tree without frames. A parent that has no entry is the root; it has a number
/// if it is one of kStandardFrames.
///
/// @param memory  of each joint that moves.
///
/// Errors: Malformed, TooLarge, Invalid (as Tree's): one line that names the frame, "frames: frame
/// 2, left_eye: …".
Result<GraphFrames> read_frames(std::string_view text, const Memory& memory = {});

}  // namespace hc::frames
