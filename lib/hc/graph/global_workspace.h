// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which part of a running graph leads to action: the global workspace. Pure.

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include <hc/graph/plan.h>

namespace hc {

/// A part of a graph.
struct GlobalWorkspace {
  std::set<std::string> modules;
  std::set<std::size_t> links;  ///< by their number in Plan::links
};

/// The modules and links of a plan through which what is sensed becomes what is done, while a mode
/// is in focus: all that is on some way which passes a task of that mode and ends at an exclusive
/// input. A module that works in other modes only is on none; nor are links that tell the focus.
///
/// @param focus  a mode's name; empty, or one that no task has: nothing is in the workspace.
/// Cost: linear in modules and links.
GlobalWorkspace global_workspace(const Plan& plan, std::string_view focus);

}  // namespace hc
