// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands to a running graph, and how they change a graph. Pure.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <graph/graph_file.h>

namespace hc {

/// A command to a graph that runs (spec/graph.md).
struct Command {
  enum class Verb { Set, Add, Remove, Restart, Link, Unlink, Stop };

  Verb verb = Verb::Stop;
  std::vector<std::string> words;  ///< behind the verb; of `set` one, whatever its value holds

  /// Whether it changes the graph, and not only what runs of it.
  [[nodiscard]] bool is_edit() const { return verb != Verb::Restart && verb != Verb::Stop; }
};

/// Errors: Invalid.
Result<Command> parse_command(std::string_view line);

/// Changes a graph as an edit says. Problems: what it names does not exist, or exists already.
void apply_command(Graph& graph, const Command& command, Problems& problems);

}  // namespace hc
