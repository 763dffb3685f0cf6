// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds the graphs that run on this host.

#include <optional>
#include <string_view>
#include <vector>

#include <hc/contract/running_graph.h>
#include <hc/os/descriptor.h>

namespace hc {

/// The graph that this program is a module of (HC_GRAPH, set by `hc run`), if any.
std::optional<RunningGraph> own_graph();

/// The graphs of all users, by name and process, from a table in the format of /proc/net/unix.
std::vector<RunningGraph> find_running(std::string_view sockets);
/// The graphs of this user, according to the kernel's owners of the listening sockets.
std::vector<RunningGraph> find_running();

/// A connection to a graph's command socket, which closes when the graph ends.
/// Errors: Closed (no graph has that name, or its queue of connections is full).
Result<Descriptor> connect_to(const RunningGraph& graph);

}  // namespace hc
