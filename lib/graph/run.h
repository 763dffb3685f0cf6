// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a planned graph: starts, supervises, changes and stops its processes, reports their state.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/load.h>
#include <hc/base/result.h>
#include <hc/contract/graph_state.h>

namespace hc {

/// The outcome of a run.
struct RunReport {
  GraphState state;              ///< at the end
  std::vector<LogLine> results;  ///< results and errors, by module
  bool stopped = false;          ///< on request

  [[nodiscard]] bool has_errors() const {
    return std::ranges::find(results, Level::Error, &LogLine::level) != results.end();
  }
};

/// How often a module is restarted.
struct RestartLimits {
  std::size_t starts_at_once = 5;  ///< starts without a delay, within `window`
  std::chrono::nanoseconds window = std::chrono::seconds(10);
  std::chrono::nanoseconds first_delay = std::chrono::milliseconds(100);
  std::chrono::nanoseconds longest_delay = std::chrono::seconds(30);
  int delayed_starts = 8;  ///< given up after these, if none ran for `window`
};

/// Time limits of supervision.
struct SupervisionLimits {
  RestartLimits restarts;
  std::chrono::nanoseconds grace = std::chrono::seconds(5);  ///< between SIGTERM and SIGKILL
  /// A module is stalled after this time without a report, once it has sent one.
  std::chrono::nanoseconds stall = std::chrono::milliseconds(1500);
  /// Least time for the first report of a module that takes commands and has a `hang`: it may have
  /// to load libraries.
  std::chrono::nanoseconds first_report = std::chrono::seconds(60);
};

struct RunOptions {
  int stop = -1;  ///< readable when the graph must end
  /// Gets events and the log lines of modules.
  std::function<void(const LogLine& line)> event;
  bool with_module_lines = true;  ///< false: only errors, and the last lines of failed modules
  /// Called twice a second.
  std::function<void(const GraphState& state)> state;
  /// The name under which clients find the graph (spec/graph.md); empty: it serves none.
  std::string name;
  std::string file;  ///< name of the graph file in its state
  /// Reloads the graph when its files change, and plans edits, on another thread. Null: only
  /// parameters can be changed. Must outlive the run.
  GraphLoader* loader = nullptr;
  /// The other hosts, all connected; null: none. Must outlive the run.
  Hosts* hosts = nullptr;
  SupervisionLimits limits;
};

/// Runs a loaded graph with a plan until all modules have ended, a module with `restart = "never"`
/// fails, or `stop` is readable. On return all its processes have ended.
///
/// Errors: System; Closed if a module failed, with its name and status.
Result<RunReport> run_graph(LoadedGraph graph, const RunOptions& options);

}  // namespace hc
