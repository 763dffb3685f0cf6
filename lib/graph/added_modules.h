// SPDX-License-Identifier: Apache-2.0
#pragma once
// The modules that options of `hc run` add to a graph: the page's server, and the recorder. Pure.
// Internal to graph.

#include <map>
#include <string>
#include <vector>

#include <graph/graph_file.h>
#include <graph/plan.h>

namespace hc {

/// `--page`: makes the graph's module `web` open a browser, or adds one; if the graph has a
/// workspace, the added page can stop the robot and choose its task.
void add_page(Graph& graph, const std::string& listen, Problems& problems);

/// The outputs without a link that are recorded: `trace` of each module that has it, and the
/// outputs of modules at the ends of chains, which are the results of the graph.
std::vector<GraphPort> recorded_unlinked(const Graph& graph, const Describe& describe);

/// `--record`: adds a module `recorder` on the host of `hc run` that records every linked output
/// and the focus: either to one MCAP file, without making modules wait, or to a folder, without
/// losing messages while the recorder runs.
/// @param unlinked  outputs of its modules that are recorded too.
/// @param parameters  of the recorder: `file` or `folder`, and others.
/// @returns  its inputs, one for each output; its program's `--describe` does not list them.
std::vector<std::string> add_recorder(Graph& graph, const std::vector<GraphPort>& unlinked,
                                      const std::string& program,
                                      const std::map<std::string, std::string>& parameters);

/// Adds inputs of any type to a description.
Result<std::string> with_inputs(const std::string& text, const std::vector<std::string>& inputs);

}  // namespace hc
