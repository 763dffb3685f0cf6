// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads the tables of a graph file, each kind in a file of its own. Internal to graph.

#include <hc/graph/file/fields.h>

namespace hc::internal {

/// `restart` at the top or in a module; `otherwise` where it is not given.
Restart read_restart(const Fields& fields, const Node& table, Restart default_value);

/// [modules.NAME] @param restart  of those that do not say it.
void read_modules(const Fields& fields, const Node& root, Restart restart, Graph& graph);

/// [[links]]
void read_links(const Fields& fields, const Node& root, Graph& graph);

/// [groups], [modes] and [workspace]
void read_groups(const Fields& fields, const Node& root, Graph& graph);
void read_modes(const Fields& fields, const Node& root, Graph& graph);
void read_workspace(const Fields& fields, const Node& root, Graph& graph);

/// [frames.NAME]
void read_frames(const Fields& fields, const Node& root, Graph& graph);

/// A graph that is included, under the names that it has there.
Graph with_prefix(Graph graph, const std::string& name);

/// Puts what is included behind what is there.
void append(Graph& graph, Graph included, Problems& problems);

}  // namespace hc::internal
