// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the tables of a graph file. Internal to graph.

#include <graph/file/fields.h>

namespace hc::internal {

/// Longest `timeout` and `hang`. [s]
inline constexpr std::int64_t kMaxSeconds = 86'400;

/// `restart`, of a file or a module.
Fields::Take read_restart(const Fields& fields, Restart& to);

/// [modules.NAME]: overrides what the module has.
///
/// @param name  of a module of the graph.
void read_module(const Fields& fields, const Node& node, const std::string& name, Graph& graph);

/// [hosts.NAME], [modes], [workspace] and [frames.NAME]
Fields::Take read_hosts(const Fields& fields, Graph& graph);
Fields::Take read_modes(const Fields& fields, Graph& graph);
Fields::Take read_workspace(const Fields& fields, Graph& graph);
Fields::Take read_frames(const Fields& fields, Graph& graph);

/// An included graph with `name` and "_" before its names.
Graph with_prefix(Graph graph, const std::string& name);

/// Appends an included graph.
void append(Graph& graph, Graph included, Problems& problems);

}  // namespace hc::internal
