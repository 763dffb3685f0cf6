// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the verbs that take a graph file share.

#include <memory>

#include <graph/hosts.h>
#include <graph/load.h>

#include "verbs.h"

namespace tool {

void add_graph_options(CLI::App& verb, hc::LoadOptions& options);

/// Other hosts, none of which is connected to yet.
std::unique_ptr<hc::Hosts> make_hosts();

/// Loads a graph that does not run yet. Where something is wrong it prints all of that, a line
/// each, and fails with status 2; where there is no such file, it names the shipped graphs.
hc::LoadedGraph load_graph(std::string_view verb, hc::GraphLoader& loader);
/// The same of a plan that is only looked at.
/// @param hosts  that it is checked with; null: its own.
hc::Plan load_plan(std::string_view verb, const hc::LoadOptions& options,
                   hc::Hosts* hosts = nullptr);

}  // namespace tool
