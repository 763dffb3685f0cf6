// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a graph: modules, the links between them, and commands of clients. Internal to graph.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <graph/run.h>
#include <graph/run/ended_links.h>
#include <graph/run/graph_changes.h>
#include <graph/run/graph_log.h>
#include <graph/run/graph_server.h>
#include <graph/run/running_modules.h>
#include <hc/os/loop.h>

namespace hc::internal {

class Runner {
 public:
  /// @param graph  with a plan. @param loop  of the hosts, if there are any.
  Runner(LoadedGraph graph, const RunOptions& options, Loop& loop);

  Result<RunReport> run();

 private:
  using Commands = GraphChanges::Commands;
  struct Failure {
    std::string module;
    int status;
  };

  Status begin();
  Result<std::unique_ptr<Supervised>> make(const PlannedModule& module);

  void tick();
  void update_hosts();
  void settle();
  void settle_failures();
  void end_all();

  GraphAnswer answer_to(const GraphCommand& question);
  Result<std::string> observe(const std::string& port);
  Result<std::string> feed(const std::string& port);
  Result<std::string> open_port(bool is_input, const std::string& port);
  [[nodiscard]] Result<std::string> describe(const std::string& module) const;
  [[nodiscard]] std::vector<std::string> notices() const;
  void carry_out(const Commands& commands);
  GraphAnswer set_parameters(const Commands& commands);
  void change_to(Plan plan);
  void add(const PlannedModule& module);

  [[nodiscard]] GraphState state() const;

  const RunOptions& options_;
  Plan plan_;
  MonotonicTime begun_{0};
  int ticks_ = 0;
  bool is_stopping_ = false, is_stopped_ = false;
  bool is_running_ = false;    // all first modules have run
  bool is_unsettled_ = false;  // a module has started or ended, or links have changed
  std::vector<Failure> failures_;
  Status outcome_;
  std::map<std::pair<bool, std::string>, int> opened_;  // numbers of ports that have been opened
  Loop& loop_;
  GraphLog log_{options_, plan_};
  std::unique_ptr<GraphServer> server_;
  RunningModules modules_{plan_};
  GraphChanges changes_;
  EndedLinks ended_links_;
  Loop::Handle stop_, tick_, hosts_;
};

}  // namespace hc::internal
