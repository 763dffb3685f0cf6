// SPDX-License-Identifier: Apache-2.0
#pragma once
// The global workspace: the part of a running graph through which perception becomes action. Pure.

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include <graph/plan.h>

namespace hc {

/// A part of a graph.
struct GlobalWorkspace {
  std::set<std::string> modules;
  std::set<std::size_t> links;  ///< indices into Plan::links
};

/// The modules and links on a path that passes through a task in focus and ends at an exclusive
/// input. Modules that are idle in the current mode, and links that carry the focus, are excluded.
///
/// @param focus  the name of the mode in focus, by workspace; modules of a workspace whose mode is
/// empty or unknown are excluded.
/// Cost: linear in modules and links.
GlobalWorkspace global_workspace(const Plan& plan, const std::map<std::string, std::string>& focus);

}  // namespace hc
