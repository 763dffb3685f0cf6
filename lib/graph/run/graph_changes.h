// SPDX-License-Identifier: Apache-2.0
#pragma once
// Queues the changes of a running graph, by its files and by commands, and plans them one after
// another on a thread beside. Internal to graph.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <graph/run/graph_log.h>
#include <hc/os/aside.h>
#include <hc/os/file_watch.h>
#include <hc/os/loop.h>

namespace hc::internal {

class GraphChanges {
 public:
  using Commands = std::vector<GraphCommand>;
  /// What the runner of the graph does.
  struct Callbacks {
    std::function<GraphAnswer(const GraphCommand& question)> answer;
    /// Sets all parameters, or none. The answer lists restarted modules.
    std::function<GraphAnswer(const Commands& commands)> set_parameters;
    std::function<void(Plan plan)> change_to;
    /// Executes the commands that do not change the plan.
    std::function<void(const Commands& commands)> carry_out;
  };

  /// @param graph  from which `plan` was made. @param loader  null: only parameters can be changed.
  /// Loader, plan and log must outlive it.
  GraphChanges(Loop& loop, GraphLoader* loader, Graph graph, const Plan& plan, GraphLog& log,
               Callbacks callbacks)
      : loop_(loop),
        loader_(loader),
        graph_(std::move(graph)),
        plan_(plan),
        log_(log),
        callbacks_(std::move(callbacks)) {}

  /// Reloads the graph from now on when its files change. Errors: System.
  Status watch_files();
  /// Executes all commands of a request, or none.
  void obey(const std::vector<std::string>& lines, const GraphServer::Reply& reply);
  /// Refuses the queued changes, and all others from now on.
  void stop();

  [[nodiscard]] const Graph& graph() const { return graph_; }

 private:
  struct Change {
    Commands commands;  // empty: a file was edited
    GraphServer::Reply reply;
  };

  void reload();
  void begin();
  void begin_planning(std::function<Result<LoadedGraph>(int stop)> plan);
  void take_planned(Result<LoadedGraph>& loaded);
  void end(const GraphAnswer& answer);

  Loop& loop_;
  GraphLoader* loader_;
  Graph graph_;
  const Plan& plan_;
  GraphLog& log_;
  Callbacks callbacks_;
  std::unique_ptr<FileWatch> files_;
  bool is_file_gone_ = false;  // the graph file was removed
  bool is_stopping_ = false;
  std::deque<Change> changes_;  // the first may be in planning
  Aside planning_;
};

}  // namespace hc::internal
