// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by the verbs that take a graph file.

#include <memory>

#include <graph/hosts.h>
#include <graph/load.h>

#include "verbs.h"

namespace tool {

void add_graph_options(CLI::App& verb, hc::LoadOptions& options);

/// The other hosts of a graph, not connected yet.
std::unique_ptr<hc::Hosts> make_hosts();

/// Loads a graph that does not run yet. Prints all problems, a line each, and fails with status 2;
/// for a missing file, lists the shipped graphs.
hc::LoadedGraph load_graph(std::string_view verb, hc::GraphLoader& loader);
/// Loads a plan for inspection only.
/// @param hosts  null: temporary ones.
hc::Plan load_plan(std::string_view verb, const hc::LoadOptions& options,
                   hc::Hosts* hosts = nullptr);

}  // namespace tool
