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

/// What a loader gave of a graph file. Prints all problems, a line each, and fails with status 2;
/// if the file is missing, names the shipped graphs.
hc::LoadedGraph without_problems(std::string_view verb, const std::string& file,
                                 hc::Result<hc::LoadedGraph> loaded);
/// Loads a plan. @param hosts  null: it needs none, as its programs are taken from this one.
hc::Plan load_plan(std::string_view verb, const hc::LoadOptions& options, hc::Hosts* hosts);
/// Loads a plan to look at, by the programs of this host. Other hosts need not be there, unless
/// they have a program that this one lacks.
hc::Plan look_at_plan(std::string_view verb, const hc::LoadOptions& options);

}  // namespace tool
