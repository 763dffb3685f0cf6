// SPDX-License-Identifier: Apache-2.0
#pragma once
// Serves a running graph to clients, processes of the same user: state and log over one link,
// commands over another (spec/graph.md, G45 … G47). Internal to graph.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <graph/run/announcer.h>
#include <hc/contract/graph_command.h>
#include <hc/contract/graph_state.h>
#include <hc/contract/log_line.h>
#include <hc/contract/running_graph.h>
#include <hc/link/intake.h>

namespace hc::internal {

class GraphServer {
 public:
  using Reply = std::function<void(const GraphAnswer& answer)>;
  struct Callbacks {
    std::function<GraphState()> state;
    /// Executes all of the commands or none, and replies at once or later; `reply` may be empty.
    std::function<void(const std::vector<std::string>& commands, Reply reply)> obey;
  };

  /// Errors: System (the graph's name is in use).
  static Result<std::unique_ptr<GraphServer>> make(Loop& loop, const RunningGraph& graph,
                                                   Callbacks callbacks);

  /// Publishes the state if there are clients.
  void publish_state();
  /// Publishes the state soon; combines several calls.
  void changed();
  void log(const LogLine& line);
  [[nodiscard]] bool has_clients() const { return states_->has_peers(); }

 private:
  GraphServer(Loop& loop, Callbacks callbacks) : loop_(loop), callbacks_(std::move(callbacks)) {}

  Message state_message();
  void take_request(const Message& message) const;

  Loop& loop_;
  Callbacks callbacks_;
  std::int64_t states_sent_ = 0, lines_sent_ = 0;
  Loop::Handle soon_;
  std::unique_ptr<Announcer> states_;
  std::unique_ptr<Intake> commands_;
};

}  // namespace hc::internal
