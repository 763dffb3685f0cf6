// SPDX-License-Identifier: Apache-2.0
#pragma once
// How commands change a graph. Pure.

#include <graph/graph_file.h>
#include <hc/contract/graph_command.h>

namespace hc {

/// Changes a graph as an edit says. Problems: what it names does not exist, or exists already.
void apply_command(Graph& graph, const GraphCommand& command, Problems& problems);

}  // namespace hc
