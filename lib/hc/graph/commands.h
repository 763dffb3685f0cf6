// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands that change a graph: what they say, and a graph that they have changed. Pure.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/graph/graph_file.h>

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

/// Changes a graph as an edit says. Problems: what it names is not there, or is there already.
void apply_command(Graph& graph, const Command& command, Problems& problems);

/// Adds an edit to those before it, each of them one that can be parsed: in the place of one that
/// it repeats, and without those that it undoes. Whatever graph they are applied to, they do the
/// same; so a slider, or a link that comes and goes, can be moved for ever.
void add_command(std::vector<std::string>& commands, const std::string& line);

}  // namespace hc
