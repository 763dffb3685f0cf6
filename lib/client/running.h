// SPDX-License-Identifier: Apache-2.0
#pragma once
// The graphs that run on this host.

#include <optional>
#include <string_view>
#include <vector>

#include <hc/contract/running_graph.h>
#include <hc/os/descriptor.h>

namespace hc {

/// The graph that this program is a module of, from HC_GRAPH, which `hc run` sets; nothing outside
/// a graph.
std::optional<RunningGraph> own_graph();

/// Those of all users, by name and process number, from a table as /proc/net/unix is.
std::vector<RunningGraph> find_running(std::string_view sockets);
/// Those of this user, as the kernel knows the processes that listen there.
std::vector<RunningGraph> find_running();

/// A connection to a graph's socket for commands, which breaks when the graph ends.
/// Errors: Closed (no graph has that name, or its queue of connections is full).
Result<Descriptor> connect_to(const RunningGraph& graph);

}  // namespace hc
