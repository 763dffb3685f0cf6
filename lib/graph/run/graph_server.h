// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a running graph offers to its clients, processes of the same user: its state and its log
// over one link, and commands over another (spec/graph.md, G45 … G47). Internal to graph.

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
    /// Does what commands say, all of them or none, and answers then or later; the reply may be
    /// empty.
    std::function<void(const std::vector<std::string>& commands, Reply reply)> obey;
  };

  /// Errors: System (the graph's name is in use).
  static Result<std::unique_ptr<GraphServer>> make(Loop& loop, const RunningGraph& graph,
                                                   Callbacks callbacks);

  /// Publishes the state, if anybody reads it.
  void publish_state();
  /// Has the state published soon, however often it is called by then.
  void changed();
  void log(const LogLine& line);
  /// Whether a client reads the state.
  [[nodiscard]] bool has_clients() const { return states_->is_heard(); }

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
