// SPDX-License-Identifier: Apache-2.0
#pragma once
// The graph file: which modules run, with which parameters, and how their ports are linked
// (spec/graph.md). Pure, but for the environment's variables that strings name.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <hc/graph/problems.h>
#include <hc/wire/element.h>

namespace hc {

/// A value of a graph file, and the line where it stands; 0: it came from elsewhere.
template <typename T>
struct Lined {
  T value;
  int line = 0;
};

/// When a module that has ended is started again.
enum class Restart {
  Never,    ///< and one that has failed ends the graph
  Failure,  ///< when it ended with a status that is neither 0 nor 2
  Always,
};

/// A module of a graph.
struct GraphModule {
  std::string name;                                      ///< snake_case
  std::string program;                                   ///< a module's name, or a path
  std::map<std::string, Lined<std::string>> parameters;  ///< as text, as on a command line
  std::map<std::string, Lined<std::int64_t>> addresses;  ///< of output ports
  std::map<std::string, Lined<Encoding>> encodings;      ///< of output ports
  int line = 0;                                          ///< of the file
};

/// A port of a module of a graph.
struct GraphPort {
  std::string module, port;
  [[nodiscard]] std::string text() const { return module + "." + port; }
};

/// A link, from an output to an input.
struct GraphLink {
  GraphPort from, to;
  /// `keep`, `rate` and so on, as in a link's URI.
  std::map<std::string, Lined<std::string>> policy;
  int line = 0;
};

struct Graph {
  std::string file;  ///< as it was given, for error lines
  std::vector<GraphModule> modules;
  std::vector<GraphLink> links;

  /// The module of that name; null where there is none.
  [[nodiscard]] GraphModule* find(std::string_view name);
};

/// Looks a variable of the environment up; null where it is not set.
using Environment = std::function<const char*(const char* name)>;

/// Largest graph file that is read. [byte]
inline constexpr std::size_t kMaxGraphBytes = std::size_t{1} << 20;

/// Most dots in a key, and most brackets within brackets, of a graph file; sensible ones have
/// three.
inline constexpr int kMaxGraphDepth = 16;

/// Reads a graph file's text. `${NAME:-otherwise}` in a parameter stands for a variable of the
/// environment. Where there are problems, the graph has what can be made out of the rest.
Graph parse_graph(std::string_view text, const Environment& environment, Problems& problems);

/// Sets a parameter, from "MODULE.PARAMETER=VALUE".
void set_parameter(Graph& graph, std::string_view assignment, Problems& problems);

}  // namespace hc
