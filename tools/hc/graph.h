// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the verbs that take a graph file share: from its name to a plan, or all that is wrong.

#include <map>
#include <string>
#include <vector>

#include <hc/graph/run.h>

#include "verbs.h"

namespace tool {

/// Which graph, and what is set beside its file.
struct GraphOptions {
  std::string file;
  std::vector<std::string> settings;  ///< MODULE.PARAMETER=VALUE
  std::string record;                 ///< folder for what all outputs send; empty: none
};
void add_graph_options(CLI::App& verb, GraphOptions& options);

/// The texts of files that have been read, by their names.
using Texts = std::map<std::string, std::string>;

/// Checks and plans a graph that commands have changed, one after the other.
///
/// @param texts  of the files that it is made of; those that are not there are read, and added.
/// @param before  the plan by which it runs, whose numbers stay; null: it does not run.
/// @param stop  descriptor that is readable when no program is to be waited for any more.
///
/// Errors: NotFound (the file). All else that is wrong stands in Replanned::problems.
hc::Result<hc::Replanned> plan_graph(const GraphOptions& options, const std::string& token,
                                     Texts& texts, const std::vector<std::string>& commands = {},
                                     const hc::Plan* before = nullptr, int stop = -1);

/// The same for a graph that does not run yet. Where something is wrong it says all of that, a line
/// each, and fails with status 2.
hc::Replanned make_plan(std::string_view verb, const GraphOptions& options,
                        const std::string& token, Texts& texts);
hc::Replanned make_plan(std::string_view verb, const GraphOptions& options,
                        const std::string& token);

}  // namespace tool
