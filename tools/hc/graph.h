// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the verbs that take a graph file share: from its name to a plan, or all that is wrong.

#include <string>
#include <vector>

#include <hc/graph/plan.h>

#include "verbs.h"

namespace tool {

/// Which graph, and what is set beside its file.
struct GraphOptions {
  std::string file;
  std::vector<std::string> settings;  ///< MODULE.PARAMETER=VALUE
};
void add_graph_options(CLI::App& verb, GraphOptions& options);

/// Reads, checks and plans a graph. Where something is wrong it says all of that, a line each, and
/// fails with status 2.
hc::Plan make_plan(std::string_view verb, const GraphOptions& options);

}  // namespace tool
