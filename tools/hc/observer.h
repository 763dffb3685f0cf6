// SPDX-License-Identifier: Apache-2.0
#pragma once
// Graphs that run on this host, seen from outside: which there are, their states, and commands to
// them. spec/graph.md (G45 … G47) has their words.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hc/contract/graph_state.h>
#include <hc/observe/running.h>

namespace tool {

using hc::find_running;
using hc::Observation;
using hc::RunningGraph;

/// The graph that a person means: by its name, or NAME.PROCESS where several have that. Without a
/// name: $HC_GRAPH; else the only one; else the only one that was started in this terminal, or in
/// this folder. Fails with the list of them otherwise.
RunningGraph choose_running(const std::string& name);

/// Receives the states of a running graph.
class Observer {
 public:
  explicit Observer(const RunningGraph& graph);

  /// The next state; nothing when the graph has ended or we are to stop. Skips to the newest.
  /// @param inputs  descriptors that end the wait too when one is readable: the last state again.
  std::optional<hc::GraphState> next(const std::vector<int>& inputs = {});

  /// A state with the load of processors and memory, which a graph measures while it is watched.
  std::optional<hc::GraphState> next_measured();

 private:
  std::string name_;
  std::unique_ptr<hc::Source> source_;
  hc::GraphState state_;
};

/// Has a graph do what the commands say, a row each; gives what it answers behind "ok", and fails
/// with any other answer.
std::vector<std::string> command_graph(const RunningGraph& graph,
                                       const std::vector<std::string>& commands);

/// As Observation::make(); fails where that does.
Observation make_observation(const RunningGraph& graph, const std::string& port);

/// An observation that lasts as long as this process; a child process renews it, and ends this one
/// with SIGTERM when the graph ends.
/// For a process that has no links yet.
std::string observe(const RunningGraph& graph, const std::string& port);

/// Whether a module of a running graph has this port, MODULE.PORT.
///
/// @param of  name of the graph; empty: as choose_running(), and no port where that fails.
bool is_running_port(const std::string& text, const std::string& of);

/// What a person names as a source: a URI, a file, or MODULE.PORT of a running graph. A port comes
/// before a file of the same name, which ./MODULE.PORT is.
///
/// @param of  name of the running graph; empty: as choose_running().
/// @returns  the URI to read.
std::string source_uri(const std::string& text, const std::string& of);

}  // namespace tool
