// SPDX-License-Identifier: Apache-2.0
#pragma once
// The head that a module assumes without a graph file.

#include <string_view>

namespace hc::frames {

/// In the form of the parameter `frames` (spec/graph.md, G31): a pan-tilt unit 1.2 m above the
/// floor, two eyes 0.10 m apart and two ears, as in graphs/simulated_head.toml.
inline constexpr std::string_view kDefaultHead =
    "robot 2 world 0 0 1.2 0 0 0 1; head 3 robot neck.pose 0; "
    "left_eye 4 head 0.06 0.05 0.05 -0.5 0.5 -0.5 0.5; "
    "right_eye 5 head 0.06 -0.05 0.05 -0.5 0.5 -0.5 0.5; "
    "left_ear 0 head 0 0.09 0.03 0 0 0 1; right_ear 0 head 0 -0.09 0.03 0 0 0 1";

}  // namespace hc::frames
