// SPDX-License-Identifier: Apache-2.0
#pragma once
// From a graph to the commands that run it: every name is checked against what the modules say of
// themselves (--describe), and every link gets its two ends. Pure.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <graph/graph_file.h>
#include <hc/base/parameter.h>

namespace hc {

struct HeldPort;

/// One end of a link, as a module gets it.
struct PlannedEnd {
  bool is_input = false;
  std::string port, uri;
  std::string route;  ///< the words of --route; empty: none

  /// "PORT=URI"
  [[nodiscard]] std::string text() const { return port + "=" + uri; }
};

/// A process that is to run.
struct PlannedModule {
  std::string name;
  std::string program;                            ///< a path, or a name that PATH has
  std::string host;                               ///< that it runs on; empty: that of `hc run`
  std::string group;                              ///< the graph that includes it; empty: none
  std::vector<std::string> options;               ///< what is said neither below nor by links
  std::map<std::string, std::string> parameters;  ///< as text
  std::map<std::string, ParameterState> known;    ///< all that it has, to check values with
  std::string description;                        ///< of its program, one line of JSON
  std::vector<PlannedEnd> ends;                   ///< in the order of the file's links
  std::string manage_uri;                         ///< where the runner listens to it
  std::string control_uri;  ///< where it listens to the runner; empty: it does not
  Restart restart = Restart::Failure;
  std::chrono::seconds hang{0};     ///< without a report for so long it is restarted; 0: never
  std::string mode;                 ///< of a task; empty: none
  std::vector<std::string> modes;   ///< it works in; empty: all
  std::string workspace;            ///< whose focus it obeys; empty: none
  std::set<std::string> exclusive;  ///< inputs that take the mode in focus alone
  bool ends_graph = false;          ///< when it has ended with status 0

  void add_option(std::string option, std::string value) {
    options.insert(options.end(), {std::move(option), std::move(value)});
  }

  /// Whether a parameter can have a value. Errors: Invalid.
  [[nodiscard]] Status check_parameter(const std::string& parameter,
                                       const std::string& value) const;

  /// Whether a new value of a parameter restarts it: it is fixed, or the module takes no commands.
  [[nodiscard]] bool is_fixed(const std::string& parameter) const {
    const auto found = known.find(parameter);
    return control_uri.empty() || (found != known.end() && found->second.options.fixed);
  }

  /// Program and arguments, as it is started.
  [[nodiscard]] std::vector<std::string> command() const;
};

/// A link. Its ends stand in its modules' PlannedModule::ends, by port and URI.
struct PlannedLink {
  std::string from, to;                       ///< "MODULE.PORT", or a URI of the world outside
  std::string sender_uri, reader_uri;         ///< empty: the end is outside
  std::string keep;                           ///< what it does when its reader is slow
  std::map<std::string, std::string> policy;  ///< the rest of it: `rate` and so on
  bool lasts = false;                         ///< its reader waits for its writer's next process

  /// One of its ends, without its route.
  [[nodiscard]] PlannedEnd end(bool is_input) const {
    const std::string& name = is_input ? to : from;
    return {is_input, name.substr(name.find('.') + 1), is_input ? reader_uri : sender_uri, {}};
  }
};

struct Plan {
  std::vector<PlannedModule> modules;
  std::vector<PlannedLink> links;
  std::string token;                              ///< as it was given
  std::map<std::string, std::int64_t> modes;      ///< their numbers
  std::map<std::string, std::int64_t> sources;    ///< of outputs, "MODULE.PORT": their `src`
  std::map<std::string, std::int64_t> addresses;  ///< of inputs that have one, "MODULE.PORT"
  std::set<std::string> workspaces;               ///< modules that publish the focus
  std::vector<std::string> unlinked;              ///< outputs without a link, "MODULE.PORT"
  std::vector<std::string> warnings;              ///< what may not be meant, as Problems::lines()
  /// Of links over TCP, by their names: the port is theirs for as long as a plan has it.
  std::map<std::string, std::shared_ptr<const HeldPort>> ports;
  std::string frames;  ///< as text (G31), by the names of the file
};

/// From a module to those that its messages lead to.
using Ways = std::map<std::string, std::set<std::string>>;

/// All modules that ways lead to from some, these included.
std::set<std::string> reach(const Ways& ways, std::set<std::string> modules);

/// Gives what `program --describe` prints on a host (empty: that of `hc run`).
using Describe =
    std::function<Result<std::string>(const std::string& program, const std::string& host)>;

/// Gives a link over TCP its port on the host of its writer, of 127.0.0.1, or of all addresses for
/// readers on other hosts.
using HoldPort = std::function<Result<std::shared_ptr<const HeldPort>>(const std::string& host,
                                                                       bool is_for_others)>;

/// What links to and from another host need.
struct HostPlace {
  std::string address;      ///< at which other hosts reach it
  std::string runner;       ///< at which it reaches the host of `hc run`
  std::string fingerprint;  ///< of its key, which is for this run alone
};
/// By name; of the host of `hc run` (empty) only the fingerprint is needed.
using HostPlaces = std::map<std::string, HostPlace>;

/// The file of the key of its host, as every module that has a link to another host finds it: a
/// descriptor that it is started with.
inline constexpr int kKeyDescriptor = 3;
inline constexpr std::string_view kKeyFile = "/proc/self/fd/3";

/// Checks a graph and plans it.
///
/// @param token  a word that no other running graph has; the names of links begin with it.
///
/// The names of links say what they join, so they stay the same when a graph is planned again.
///
/// Ports without an address get the least ones that are free, in the order of the file.
///
/// @param before  a plan of this graph whose addresses and TCP ports stay, so that modules that
/// have not changed are planned as they were; null: there was none.
/// @param hold_port  null: such links have port 0, and the plan cannot be run.
/// @param places  of the hosts that modules run on.
///
/// Problems: as spec/graph.md lists them; of a graph that is not whole none, as what it lacks may
/// be what is named. Nothing more is said of a module without a program (empty), whose problem has
/// been reported. The plan is of no use where there are problems.
Plan make_plan(Graph graph, const Describe& describe, std::string_view token, Problems& problems,
               const Plan* before = nullptr, const HoldPort& hold_port = {},
               const HostPlaces& places = {});

}  // namespace hc
