// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a planned graph: starts its processes and supervises them, has them changed while they run,
// reports what they do, and takes all of them down together.

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

/// What a graph has done.
struct RunReport {
  GraphState state;              ///< at its end
  std::vector<LogLine> results;  ///< and errors, by module
  bool stopped = false;          ///< ended because it was asked to

  [[nodiscard]] bool has_errors() const {
    return std::ranges::find(results, Level::Error, &LogLine::level) != results.end();
  }
};

/// How often a module is restarted.
struct RestartLimits {
  std::size_t starts_at_once = 5;                              ///< so many …
  std::chrono::nanoseconds window = std::chrono::seconds(10);  ///< … within this time
  std::chrono::nanoseconds first_delay = std::chrono::milliseconds(100);
  std::chrono::nanoseconds longest_delay = std::chrono::seconds(30);
  int delayed_starts = 8;  ///< so many with a delay, none of which ran for `window`: given up
};

/// How patient a graph is with its modules.
struct SupervisionLimits {
  RestartLimits restarts;
  std::chrono::nanoseconds grace = std::chrono::seconds(5);  ///< between SIGTERM and SIGKILL
  /// Without a report from a module that has reported before: stalled.
  std::chrono::nanoseconds stall = std::chrono::milliseconds(1500);
  /// For the first report of a module that takes commands and has a `hang`, where that is not
  /// longer: it may have to load what it needs.
  std::chrono::nanoseconds first_report = std::chrono::seconds(60);
};

struct RunOptions {
  int stop = -1;  ///< descriptor that is readable when the graph is to end
  /// Gets events, and the lines of modules.
  std::function<void(const LogLine& line)> event;
  bool with_module_lines = true;  ///< false: only errors, and the last ones of a module that fails
  /// Called with the state of the graph, twice a second.
  std::function<void(const GraphState& state)> state;
  /// Where others find the graph: it has two links of that name (spec/graph.md). Empty: none.
  std::string name;
  std::string file;  ///< what its state calls the graph file
  /// Loads the graph again when its files change, and plans what commands change in it, on another
  /// thread. Null: only parameters can be changed. Must outlive the run.
  GraphLoader* loader = nullptr;
  /// Other hosts, those of the plan connected to; null: there are none. Must outlive the run.
  Hosts* hosts = nullptr;
  SupervisionLimits limits;
};

/// Runs a loaded graph, which has a plan, to its end: until all modules have ended, one fails that
/// is never restarted, or `stop` is readable. Nothing that it started is left then.
///
/// Errors: System; Closed when a module failed, with its name and status.
Result<RunReport> run_graph(LoadedGraph graph, const RunOptions& options);

}  // namespace hc
