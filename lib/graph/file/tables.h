// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the tables of a graph file, each kind in a file of its own. Internal to graph.

#include <graph/file/fields.h>

namespace hc::internal {

/// `restart`, of a file or a module.
/// Longest `timeout` and `hang`. [s]
inline constexpr std::int64_t kMaxSeconds = 86'400;

Fields::Take read_restart(const Fields& fields, Restart& to);

/// [modules.NAME]: what it says goes over what the module has.
///
/// @param name  of the module in the graph, which has it.
void read_module(const Fields& fields, const Node& node, const std::string& name, Graph& graph);

/// [hosts.NAME], [modes], [workspace] and [frames.NAME]
Fields::Take read_hosts(const Fields& fields, Graph& graph);
Fields::Take read_modes(const Fields& fields, Graph& graph);
Fields::Take read_workspace(const Fields& fields, Graph& graph);
Fields::Take read_frames(const Fields& fields, Graph& graph);

/// An included graph, under the names that it has in the graph around it.
Graph with_prefix(Graph graph, const std::string& name);

/// Appends an included graph.
void append(Graph& graph, Graph included, Problems& problems);

}  // namespace hc::internal
