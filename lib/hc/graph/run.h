// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a planned graph: starts its processes and supervises them, has them changed while they run,
// tells what they do, and takes all of them down together.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <hc/graph/limits.h>
#include <hc/graph/plan.h>
#include <hc/graph/state.h>

namespace hc {

/// What a graph has done.
struct RunReport {
  GraphState state;                  ///< at its end
  std::vector<std::string> results;  ///< "MODULE: …", from lines `result: …` of modules
  bool stopped = false;              ///< ended because it was told to
};

/// What came of planning a graph anew.
struct Replanned {
  std::optional<Plan> plan;           ///< nothing: it cannot be run, and `problems` say why
  std::vector<std::string> problems;  ///< lines
  std::vector<std::string> files;     ///< that it is made of: editing one makes it planned anew
};

/// What a graph is planned anew of: its files as they are now, or as they were when a plan was made
/// of them last.
enum class Reading { Anew, AsBefore };

struct RunOptions {
  int stop = -1;  ///< descriptor that is readable when the graph is to end
  /// Hears one line for each event, and what modules say; each begins with a module's name, or
  /// "graph".
  std::function<void(std::string_view line)> event;
  bool tells_lines = true;  ///< that modules say; otherwise the last ones of a module that fails
  /// Hears what the graph does, twice a second.
  std::function<void(const GraphState& state)> state;
  /// Where others find the graph: it has two links of that name (spec/graph.md). Empty: none.
  std::string name;
  std::string file;  ///< what its state calls the graph file
  /// Plans the graph anew, with the token and the numbers of the plan that runs: of its files,
  /// changed by commands (commands.h) one after the other. Empty: it stays as it is. It is called
  /// on another thread, and fails soon when the descriptor `stop` is readable.
  std::function<Replanned(Reading reading, const std::vector<std::string>& commands,
                          const Plan& running, int stop)>
      replan;
  std::vector<std::string> files;  ///< as Replanned::files, of the first plan
  SupervisionLimits limits;
};

/// Runs a graph to its end: until all modules have ended, one fails that is never restarted, or
/// `stop` is readable. Nothing that it started is left then.
///
/// Errors: NotFound (a program), System; Closed when a module failed, with its name and status.
Result<RunReport> run_graph(Plan plan, const RunOptions& options);

/// What `program --describe` prints, at most 1 MiB, within 10 s.
///
/// Errors: NotFound (no such program), System (it failed), Stopped (`stop` is readable).
Result<std::string> describe_program(const std::string& program, int stop = -1);

/// A word for make_plan() that no other running graph has.
std::string graph_token();

}  // namespace hc
