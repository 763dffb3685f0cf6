// SPDX-License-Identifier: Apache-2.0
#pragma once
// Chooses, observes and commands running graphs of this host (spec/graph.md, G45 … G47).

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

/// Chooses a graph by NAME, or NAME.PROCESS if several have that name. Without a name: $HC_GRAPH,
/// or the only graph, or the only one started in this terminal, or in this folder. Otherwise fails
/// with a list of the running graphs.
RunningGraph choose_running(const std::string& name);

/// Receives the states of a running graph.
class Observer {
 public:
  explicit Observer(const RunningGraph& graph);

  /// Waits for the next state; nullopt when the graph has ended, or when asked to stop.
  /// @param inputs  descriptors that end the wait when readable; then it returns the last state.
  std::optional<hc::GraphState> next(const std::vector<int>& inputs = {});

  /// Waits for a state with CPU and memory usage, which a graph measures only while observed.
  std::optional<hc::GraphState> next_measured();

 private:
  std::unique_ptr<hc::Loop> loop_;
  hc::GraphClient client_;
  hc::GraphState state_;
  bool is_new_ = false, has_ended_ = false;
};

/// The state of a graph. Fails if it has ended.
/// @param is_measured  as next_measured().
hc::GraphState state_of(const RunningGraph& graph, bool is_measured = false);

/// A module of a running graph. Fails if there is none of that name.
const hc::ModuleState& find_module(const hc::GraphState& state, const std::string& name);

/// Sends commands, a row each, to a graph. Returns its answer; fails if it refuses.
std::vector<std::string> command_graph(const RunningGraph& graph,
                                       const std::vector<std::string>& commands);

/// Opens an output of a running graph. Fails as hc::open_tap() does.
std::unique_ptr<hc::Source> open_port(const RunningGraph& graph, const std::string& port);

}  // namespace tool
