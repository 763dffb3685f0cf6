// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a graph: modules, the links between them, and commands of clients. Internal to graph.

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <graph/run.h>
#include <graph/run/graph_server.h>
#include <graph/run/supervised.h>
#include <hc/os/aside.h>
#include <hc/os/file_watch.h>
#include <hc/os/loop.h>

namespace hc::internal {

class Runner {
 public:
  Runner(LoadedGraph graph, const RunOptions& options)
      : options_(options), graph_(std::move(graph.graph)), plan_(std::move(graph.plan.value())) {}

  Result<RunReport> run();

 private:
  using LinkName = std::pair<std::string, std::string>;  // from, to
  struct Failure {
    std::string module;
    int status;
  };
  struct Change {
    std::vector<GraphCommand> commands;  // empty: a file was edited
    GraphServer::Reply reply;
  };

  Status begin();
  Result<std::unique_ptr<Supervised>> make(const PlannedModule& module);
  [[nodiscard]] Supervised* find(const std::string& name) const;
  /// The module of "MODULE.PORT"; null outside the graph.
  [[nodiscard]] Supervised* at(const std::string& end) const;

  [[nodiscard]] std::set<Supervised*> neighbours_of(const std::string& name) const;
  [[nodiscard]] std::set<Supervised*> cut_off_by(const std::string& name) const;

  void print(const LogLine& line) const;
  /// Prints and publishes a line.
  void log(const LogLine& line);
  void log(const std::string& text, Level level = Level::Info) { log({"graph", level, text}); }
  void take_line(LogLine line);
  [[nodiscard]] std::string with_link_names(std::string line) const;

  void tick();
  void update_hosts();
  void settle();
  void settle_failures();
  void settle_links();
  void end_unneeded();
  void end_all();
  [[nodiscard]] bool is_over() const;

  void reload();
  void obey(const std::vector<std::string>& lines, const GraphServer::Reply& reply);
  GraphAnswer answer_to(const GraphCommand& question);
  Result<std::string> observe(const std::string& port);
  [[nodiscard]] Result<std::string> describe(const std::string& module) const;
  void carry_out(const std::vector<GraphCommand>& commands);
  void begin_changes();
  void begin_planning(std::function<Result<LoadedGraph>(int stop)> plan);
  void take_planned(Result<LoadedGraph>& loaded);
  void end_change(const GraphAnswer& answer);
  void refuse_changes();
  GraphAnswer set_parameters(const std::vector<GraphCommand>& commands);
  void change_to(Plan plan);
  void add(const PlannedModule& module);

  [[nodiscard]] GraphState state() const;
  [[nodiscard]] LinkState state_of(const PlannedLink& link) const;
  [[nodiscard]] std::string waited_for(const std::string& name) const;

  [[nodiscard]] Result<std::shared_ptr<void>> drain_for(const PlannedModule& reader,
                                                        const std::string& uri) const;

  static constexpr std::size_t kMaxResults = 100;

  const RunOptions& options_;
  Graph graph_;  // from which `plan_` was made
  Plan plan_;
  MonotonicTime begun_{0};
  int ticks_ = 0;
  bool is_stopping_ = false, is_stopped_ = false;
  bool is_file_gone_ = false;  // the graph file was removed
  bool is_running_ = false;    // all first modules have run
  bool is_unsettled_ = false;  // a module has started or ended, or links have changed
  std::vector<Failure> failures_;
  std::vector<LogLine> results_;  // and errors
  Status outcome_;
  std::deque<Change> changes_;           // queued; the first may be in planning
  std::map<std::string, int> observed_;  // numbers of outputs that have been observed
  std::unique_ptr<Loop> own_loop_;       // null if hosts provide one
  Loop* loop_ = nullptr;
  std::unique_ptr<GraphServer> server_;
  std::unique_ptr<FileWatch> files_;
  Aside planning_;
  std::map<LinkName, std::shared_ptr<void>> drains_;  // replace ended readers; null: it failed
  std::map<std::string, std::unique_ptr<Supervised>> modules_, leaving_;  // by name
  Loop::Handle stop_, tick_, hosts_;
};

}  // namespace hc::internal
