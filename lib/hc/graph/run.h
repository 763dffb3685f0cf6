// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs a planned graph: starts its processes, listens to their counters and lines, and takes all of
// them down together.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>
#include <hc/graph/plan.h>
#include <hc/link/link.h>

namespace hc {

/// What a graph has done.
struct RunReport {
  /// Of each link, in the order of Plan::links: as its sender counts, and with what its reader has
  /// left out.
  std::vector<Traffic> links;
  bool stopped = false;  ///< ended because it was told to
};

struct RunOptions {
  int stop = -1;  ///< descriptor that is readable when the graph is to end
  /// Hears one line for each event, and what modules say; each begins with a module's name.
  std::function<void(std::string_view line)> event;
};

/// Runs a graph to its end: until all modules have ended, one of them fails, or `stop` is readable.
/// Nothing that it started is left then.
///
/// Errors: NotFound (a program), System; Closed when a module failed, with its name and status.
Result<RunReport> run_graph(const Plan& plan, const RunOptions& options);

/// What `program --describe` prints, at most 1 MiB, within 10 s.
///
/// Errors: NotFound (no such program), System (it failed).
Result<std::string> describe_program(const std::string& program);

/// A word for make_plan() that no other running graph has.
std::string graph_token();

}  // namespace hc
