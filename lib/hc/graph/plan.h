// SPDX-License-Identifier: Apache-2.0
#pragma once
// From a graph to the commands that run it: every name is checked against what the modules say of
// themselves (--describe), and every link gets its two ends. Pure.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/graph/graph_file.h>

namespace hc {

/// A process that is to run.
struct PlannedModule {
  std::string name;
  std::vector<std::string> command;  ///< program and arguments
  std::string manage_uri;            ///< where the runner listens for its counters
  std::size_t inputs = 0;            ///< links into it; the counters begin with these
};

/// A link, and where the counters of its ends are found.
struct PlannedLink {
  struct End {
    std::size_t module = 0;  ///< index in Plan::modules
    std::size_t row = 0;     ///< of that module's counters
  };
  GraphPort from, to;
  End sender, reader;
};

struct Plan {
  std::vector<PlannedModule> modules;
  std::vector<PlannedLink> links;
};

/// Gives what `program --describe` prints.
using Describe = std::function<Result<std::string>(const std::string& program)>;

/// Checks a graph and plans it.
///
/// @param token  a word that no other running graph has; the links' names begin with it.
///
/// Outputs without an address get the least ones that are free, in the order of the file.
///
/// Problems: an unknown module, port or parameter, a value out of range, an encoding that the
/// output's type cannot have, an input of another type than the output it is linked to, an address
/// or a link given twice, memory that is too small to be shared, a loop without a rate. Of a module
/// without a program (empty), whose problem has been told, nothing more is said. The plan is of no
/// use where there are problems.
Plan make_plan(Graph graph, const Describe& describe, std::string_view token, Problems& problems);

}  // namespace hc
