// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which part of a running graph leads to action: the global workspace. Pure.

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include <graph/plan.h>

namespace hc {

/// A part of a graph.
struct GlobalWorkspace {
  std::set<std::string> modules;
  std::set<std::size_t> links;  ///< by their number in Plan::links
};

/// The modules and links of a plan through which what is sensed becomes what is done: all that is
/// on some way which passes a task in focus and ends at an exclusive input. A module that works in
/// other modes only is on none; nor are links that carry the focus.
///
/// @param focus  of each workspace the name of its mode in focus; where that is empty or unknown,
/// none of the workspace's modules is on the global workspace.
/// Cost: linear in modules and links.
GlobalWorkspace global_workspace(const Plan& plan, const std::map<std::string, std::string>& focus);

}  // namespace hc
