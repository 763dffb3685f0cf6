// SPDX-License-Identifier: Apache-2.0
#pragma once
// The log of a running graph: for whom runs it, for clients, and the results for its end. Internal
// to graph.

#include <deque>
#include <string>
#include <vector>

#include <graph/plan.h>
#include <graph/run.h>
#include <graph/run/graph_server.h>

namespace hc::internal {

class GraphLog {
 public:
  /// Both must outlive it; the plan may change.
  GraphLog(const RunOptions& options, const Plan& plan) : options_(options), plan_(plan) {}

  /// Publishes lines from now on.
  void publish_by(GraphServer& server) { server_ = &server; }
  /// The graph stops, so warnings of its modules only say that their peers stop.
  void stop() { is_stopping_ = true; }

  /// Prints and publishes a line.
  void add(const LogLine& line);
  void add(const std::string& text, Level level = Level::Info) { add({"graph", level, text}); }
  /// Only prints a line.
  void print(const LogLine& line) const;
  /// Takes a line of a module.
  void take(LogLine line);

  /// Results and errors.
  [[nodiscard]] std::vector<LogLine>& results() { return results_; }

  /// The last notices of modules, which only the user who runs the graph may see.
  [[nodiscard]] const std::deque<LogLine>& notices() const { return notices_; }

  /// Replaces a link's URI by "MODULE.PORT → MODULE.PORT".
  [[nodiscard]] std::string with_link_names(std::string line) const;

 private:
  const RunOptions& options_;
  const Plan& plan_;
  GraphServer* server_ = nullptr;
  bool is_stopping_ = false;
  std::vector<LogLine> results_;
  std::deque<LogLine> notices_;
};

}  // namespace hc::internal
