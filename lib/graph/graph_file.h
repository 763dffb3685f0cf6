// SPDX-License-Identifier: Apache-2.0
#pragma once
// The graph file: modules, their parameters and links, and what they share (spec/graph.md).
// Pure, except for environment variables and included files.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <graph/problems.h>
#include <hc/base/uri.h>
#include <hc/contract/graph_command.h>
#include <hc/mtp/element.h>

namespace hc {

/// A value of a graph file and its position.
template <typename T>
struct Lined {
  T value{};
  Place place;
};

/// When a module that has ended is restarted.
enum class Restart {
  Never,    ///< a failure ends the graph
  Failure,  ///< if its exit status is neither 0 nor 2
  Always,
};

/// The destination of messages.
struct Addressee {
  std::string name;         ///< of an input, or `all`; empty: see `number`
  std::int64_t number = 0;  ///< an address
};

/// Another host that runs modules.
struct GraphHost {
  std::string name;
  std::vector<Lined<std::string>> ssh;  ///< arguments of ssh; the destination comes last
  Lined<std::string> program;           ///< `hc` on that host
  Lined<std::string> address;           ///< for links from other hosts; empty: that of ssh
  Place place;
};

/// A module of a graph.
struct GraphModule {
  std::string name;            ///< snake_case
  Lined<std::string> program;  ///< a module's name, or a path
  Lined<std::string> host;     ///< empty: the host of `hc run`
  std::string group;           ///< the NAME of its [graphs.NAME], within another: OTHER_NAME
  std::string prefix;          ///< added to its name by inclusion, such as "head_"
  std::map<std::string, Lined<std::string>> parameters;  ///< as text, as on a command line
  std::map<std::string, Lined<std::int64_t>> addresses;  ///< of ports
  std::map<std::string, Lined<Encoding>> encodings;      ///< of output ports
  std::map<std::string, Lined<Addressee>> to;            ///< of output ports
  Restart restart = Restart::Failure;
  std::optional<Lined<std::string>> clock;  ///< `--clock`
  Lined<std::int64_t> hang;  ///< restarted after this time without a report [s]; 0: never
  std::optional<Lined<std::string>> mode;     ///< of a task
  std::vector<Lined<std::string>> modes;      ///< in which it works; empty: all
  std::vector<Lined<std::string>> exclusive;  ///< its exclusive inputs
  std::string workspace;                      ///< the module that publishes its focus; empty: none
  bool ends_graph = false;                    ///< the graph ends when it ends with status 0
  bool is_recorder = false;                   ///< added by `--record`
  Place place;
};

/// An end of a link: a port of a module, or a URI outside the graph.
struct GraphPort {
  std::string module, port;
  std::string uri;  ///< outside the graph; empty: a port
  [[nodiscard]] std::string text() const { return uri.empty() ? module + "." + port : uri; }
};

/// A link, from an output to an input.
struct GraphLink {
  GraphPort from, to;
  /// `keep`, `rate` and so on, as in a link's URI; an empty value is an error already reported.
  std::map<std::string, Lined<std::string>> policy;
  Lined<std::string> via;  ///< "tls", "tcp" or "dds", between hosts only; empty: not given
  /// Destination addresses that pass this link; nullopt: computed.
  std::optional<Lined<std::vector<std::int64_t>>> route;
  bool routes_all = false;  ///< route = "all"
  Place place;
};

/// A system mode.
struct GraphMode {
  std::string name;
  std::int64_t number = 0;
  Place place;
};

/// A coordinate system and its pose in its parent.
struct GraphFrame {
  std::string name;
  std::string prefix;  ///< added to its name by inclusion, such as "head_"
  Lined<std::string> parent;
  std::array<double, 3> translation{};            ///< [m]
  std::array<double, 4> rotation = {0, 0, 0, 1};  ///< unit quaternion (x, y, z, w)
  std::optional<Lined<GraphPort>> moved_by;       ///< the output that sends its pose
  Lined<std::int64_t> coord;                      ///< its number in headers; 0: none
  Place place;
};

struct Graph {
  std::string file;                ///< as given, for error messages
  std::vector<std::string> files;  ///< `file` and the files it includes; see Place::file
  std::vector<GraphHost> hosts;
  std::vector<GraphModule> modules;
  std::vector<GraphLink> links;
  std::vector<GraphMode> modes;
  std::vector<GraphFrame> frames;
  bool is_whole = true;  ///< false: an included file cannot be read (already reported)
  /// Modules that publish the focus, the graph's own first; each serves the modules of its file and
  /// of the files included there. Empty: an error already reported.
  std::vector<Lined<std::string>> workspaces;

  /// The module of that name; null if not found.
  [[nodiscard]] GraphModule* find(std::string_view name);
};

/// Looks up an environment variable; null if not set.
using Environment = std::function<const char*(const char* name)>;

/// Reads at most kMaxGraphBytes + 1 bytes of a file. Errors: NotFound, System.
using ReadFile = std::function<Result<std::string>(const std::string& file)>;

/// Largest graph file. [byte]
inline constexpr std::size_t kMaxGraphBytes = std::size_t{1} << 20;

/// Most dots in a key, and most nested brackets, of a graph file; three are usual.
inline constexpr int kMaxGraphDepth = 16;

/// Most modules of a graph, including those of included files.
inline constexpr std::size_t kMaxModules = 1000;

/// Most inclusions in a graph.
inline constexpr int kMaxIncluded = 256;

/// Version of the graph file format.
inline constexpr std::int64_t kGraphVersion = 1;

/// Parses a graph file. `${NAME:-default}` in a string stands for an environment variable. Parsing
/// continues after a problem.
///
/// @param read_file  reads included files; empty: includes are errors.
Graph parse_graph(std::string_view text, const Environment& environment, Problems& problems,
                  const ReadFile& read_file = {});

/// The keys of a link's policy, in the order in which they are checked.
inline constexpr std::array<std::string_view, 10> kPolicyKeys = {
    "keep",    "rate", "burst",   "bandwidth", "memory",
    "timeout", "as",   "quality", "scale",     "idle_rate"};

/// Checks the policy in a URI's options. Errors: Invalid.
Status check_policy(Uri policy);

/// Sets a parameter. Problems: no such module.
/// @param place  of the assignment.
void set_parameter(Graph& graph, const Assignment& assignment, Problems& problems,
                   const Place& place = {});

/// Applies an edit to a graph. Problems: a name that does not exist, or exists already.
void apply_command(Graph& graph, const GraphCommand& command, Problems& problems);

}  // namespace hc
