// SPDX-License-Identifier: Apache-2.0
#pragma once
// The graph file: which modules run, with which parameters, how their ports are linked, and what
// they share (spec/graph.md). Pure, except for the environment's variables and included files.

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

/// A value of a graph file, and its place there.
template <typename T>
struct Lined {
  T value{};
  Place place;
};

/// When a module that has ended is restarted.
enum class Restart {
  Never,    ///< and one that has failed ends the graph
  Failure,  ///< when it ended with a status that is neither 0 nor 2
  Always,
};

/// Whom messages are for: a number, or the name of an input, or `all`.
struct Addressee {
  std::string name;         ///< empty: the number says it
  std::int64_t number = 0;  ///< an address
};

/// Another host, which modules run on.
struct GraphHost {
  std::string name;
  std::vector<Lined<std::string>> ssh;  ///< arguments of ssh, its destination the last
  Lined<std::string> program;           ///< `hc` there
  Lined<std::string> address;           ///< at which other hosts reach it; empty: as ssh does
  Place place;
};

/// A module of a graph.
struct GraphModule {
  std::string name;            ///< snake_case
  Lined<std::string> program;  ///< a module's name, or a path
  Lined<std::string> host;     ///< that it runs on; empty: that of `hc run`
  std::string group;           ///< the [graphs.NAME] that it is of
  std::string prefix;          ///< what inclusion has put before its name, "head_"
  std::map<std::string, Lined<std::string>> parameters;  ///< as text, as on a command line
  std::map<std::string, Lined<std::int64_t>> addresses;  ///< of ports
  std::map<std::string, Lined<Encoding>> encodings;      ///< of output ports
  std::map<std::string, Lined<Addressee>> to;            ///< of output ports
  Restart restart = Restart::Failure;
  std::optional<Lined<std::string>> clock;  ///< `--clock`
  Lined<std::int64_t> hang;  ///< without a report for so long it is restarted [s]; 0: never
  std::optional<Lined<std::string>> mode;     ///< a task's
  std::vector<Lined<std::string>> modes;      ///< it works in; empty: all
  std::vector<Lined<std::string>> exclusive;  ///< inputs that take the mode in focus alone
  std::string workspace;    ///< the module that publishes the focus for it; empty: none
  bool ends_graph = false;  ///< when it has ended with status 0
  Place place;
};

/// An end of a link: a port of a module, or the world outside.
struct GraphPort {
  std::string module, port;
  std::string uri;  ///< of the world outside; empty: it is a port
  [[nodiscard]] std::string text() const { return uri.empty() ? module + "." + port : uri; }
};

/// A link, from an output to an input.
struct GraphLink {
  GraphPort from, to;
  /// `keep`, `rate` and so on, as in a link's URI; an empty value is wrong, and has been reported.
  std::map<std::string, Lined<std::string>> policy;
  Lined<std::string> via;  ///< "tls", "tcp" or "dds", of one between hosts; empty: not given
  /// Whom messages are for that pass this link; nothing: as computed.
  std::optional<Lined<std::vector<std::int64_t>>> route;
  bool routes_all = false;  ///< all of them do
  Place place;
};

/// A system mode.
struct GraphMode {
  std::string name;
  std::int64_t number = 0;
  Place place;
};

/// A coordinate system, and its pose in its parent.
struct GraphFrame {
  std::string name;
  std::string prefix;  ///< what inclusion has put before it, "head_"
  Lined<std::string> parent;
  std::array<double, 3> translation{};            ///< [m]
  std::array<double, 4> rotation = {0, 0, 0, 1};  ///< unit quaternion (x, y, z, w)
  std::optional<Lined<GraphPort>> moved_by;       ///< the output that sends its pose instead
  Lined<std::int64_t> coord;                      ///< its number in headers; 0: none
  Place place;
};

struct Graph {
  std::string file;                ///< as it was given, for error lines
  std::vector<std::string> files;  ///< that it is made of, the first is `file`; see Place::file
  std::vector<GraphHost> hosts;
  std::vector<GraphModule> modules;
  std::vector<GraphLink> links;
  std::vector<GraphMode> modes;
  std::vector<GraphFrame> frames;
  bool is_whole = true;  ///< false: a file that it includes cannot be read, as is reported
  /// Modules that publish which mode is in focus, the graph's own first, each for the modules of
  /// its file and of what that includes; empty: it is wrong, and has been reported.
  std::vector<Lined<std::string>> workspaces;

  /// The module of that name; null where there is none.
  [[nodiscard]] GraphModule* find(std::string_view name);
};

/// Looks a variable of the environment up; null where it is not set.
using Environment = std::function<const char*(const char* name)>;

/// Gives the text of a file, at most a byte more than kMaxGraphBytes of it. Errors: NotFound
/// (there is none), System.
using ReadFile = std::function<Result<std::string>(const std::string& file)>;

/// Largest graph file that is read. [byte]
inline constexpr std::size_t kMaxGraphBytes = std::size_t{1} << 20;

/// Most dots in a key, and most brackets within brackets, of a graph file; sensible ones have
/// three.
inline constexpr int kMaxGraphDepth = 16;

/// Most modules of a graph, with those of the graphs that it includes.
inline constexpr std::size_t kMaxModules = 1000;

/// Most files that a graph includes, each as often as it does.
inline constexpr int kMaxIncluded = 256;

/// Version of the graph file format.
inline constexpr std::int64_t kGraphVersion = 1;

/// Reads a graph file's text. `${NAME:-default}` in a string stands for a variable of the
/// environment. Where there are problems, the graph holds what can be made of the rest.
///
/// @param read_file  reads what it includes; none: nothing can be included.
Graph parse_graph(std::string_view text, const Environment& environment, Problems& problems,
                  const ReadFile& read_file = {});

/// The keys of a link's policy, in the order in which they are read.
inline constexpr std::array<std::string_view, 8> kPolicyKeys = {
    "keep", "rate", "burst", "memory", "timeout", "as", "quality", "scale"};

/// Whether a policy makes sense as far as it is in a URI's options. Errors: Invalid.
Status check_policy(Uri policy);

/// Has a module `recorder`, on the host of `hc run`, record every linked output and the focus: into
/// one file of MCAP, which makes no module wait, or into a folder, which lacks no message as long
/// as the recorder runs.
/// @param traced  modules whose output `trace` is recorded too.
/// @param parameters  of it: `file` or `folder`, and more.
/// @returns  its inputs, one for each output, which `--describe` of its program does not say.
std::vector<std::string> add_recorder(Graph& graph, const std::vector<std::string>& traced,
                                      const std::string& program,
                                      const std::map<std::string, std::string>& parameters);

/// Sets a parameter. Problems: there is no such module.
/// @param place  where that is from.
void set_parameter(Graph& graph, const Assignment& assignment, Problems& problems,
                   const Place& place = {});

/// Changes a graph as an edit says. Problems: what it names does not exist, or exists already.
void apply_command(Graph& graph, const GraphCommand& command, Problems& problems);

}  // namespace hc
