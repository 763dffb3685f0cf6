// SPDX-License-Identifier: Apache-2.0
#pragma once
// Graphs that run on this host, as the verbs of hc need them: which is meant, its states, and
// commands to it. spec/graph.md (G45 … G47) has their words.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <client/graph_client.h>
#include <client/running.h>
#include <client/tap.h>

namespace tool {

using hc::find_running;
using hc::RunningGraph;

/// The graph that a person means: by its name, or NAME.PROCESS where several have that. Without a
/// name: $HC_GRAPH; else the only one; else the only one that was started in this terminal, or in
/// this folder. Fails with the list of them otherwise.
RunningGraph choose_running(const std::string& name);

/// Receives the states of a running graph.
class Observer {
 public:
  explicit Observer(const RunningGraph& graph);

  /// The newest state, waiting for the next; nothing when the graph has ended or we are to stop.
  /// @param inputs  descriptors that end the wait too when one is readable: the last state again.
  std::optional<hc::GraphState> next(const std::vector<int>& inputs = {});

  /// A state with the load of processors and memory, which a graph measures while it is watched.
  std::optional<hc::GraphState> next_measured();

 private:
  std::unique_ptr<hc::Loop> loop_;
  hc::GraphClient client_;
  hc::GraphState state_;
  bool is_new_ = false, has_ended_ = false;
};

/// A state of a graph. Fails where it has ended.
/// @param is_measured  as of next_measured().
hc::GraphState state_of(const RunningGraph& graph, bool is_measured = false);

/// Has a graph do what the commands say, a row each; gives what it answers, and fails with what is
/// wrong.
std::vector<std::string> command_graph(const RunningGraph& graph,
                                       const std::vector<std::string>& commands);

/// An output of a running graph. Fails as hc::open_tap() does.
std::unique_ptr<hc::Source> open_port(const RunningGraph& graph, const std::string& port);

/// Whether a module of a running graph has this port, MODULE.PORT.
///
/// @param of  name of the graph; empty: as choose_running(), and no port where that fails.
bool is_running_port(const std::string& text, const std::string& of);

/// The running graph whose MODULE.PORT a person names as a source; nothing of a URI or a file. A
/// port comes before a file of the same name, which ./MODULE.PORT is.
///
/// @param of  name of the running graph; empty: as choose_running().
std::optional<RunningGraph> graph_of_port(const std::string& text, const std::string& of);

/// Opens what a person names as a source: a URI, a file, or MODULE.PORT of a running graph.
std::unique_ptr<hc::Source> open_named(const std::string& text, const std::string& of,
                                       std::uint64_t limit);

}  // namespace tool
