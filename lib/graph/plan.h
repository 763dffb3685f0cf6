// SPDX-License-Identifier: Apache-2.0
#pragma once
// From a graph to the command lines that run it: checks names against the modules' descriptions
// (--describe) and gives each link its two ends. Pure.

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

/// One end of a link, as passed to a module.
struct PlannedEnd {
  bool is_input = false;
  std::string port, uri;
  std::string route;  ///< for --route; empty: none

  /// "PORT=URI"
  [[nodiscard]] std::string text() const { return port + "=" + uri; }
};

/// A process to run.
struct PlannedModule {
  std::string name;
  std::string program;                            ///< a path, or a name found in PATH
  std::string host;                               ///< empty: the host of `hc run`
  std::string group;                              ///< the included graph it is from; empty: none
  std::vector<std::string> options;               ///< besides parameters and links
  std::map<std::string, std::string> parameters;  ///< as text
  std::map<std::string, ParameterState> known;    ///< all its parameters, to check values
  std::string description;                        ///< of its program, one line of JSON
  std::vector<PlannedEnd> ends;                   ///< in the order of the file's links
  std::string manage_uri;                         ///< for its reports
  std::string control_uri;                        ///< for its commands; empty: it takes none
  Restart restart = Restart::Failure;
  std::chrono::seconds hang{0};     ///< restarted after this time without a report; 0: never
  std::string mode;                 ///< of a task; empty: none
  std::vector<std::string> modes;   ///< in which it works; empty: all
  std::string workspace;            ///< whose focus it obeys; empty: none
  std::set<std::string> exclusive;  ///< its exclusive inputs
  bool ends_graph = false;          ///< the graph ends when it ends with status 0
  bool is_recorder = false;  ///< its inputs end also with writers that have failed permanently

  void add_option(std::string option, std::string value) {
    options.insert(options.end(), {std::move(option), std::move(value)});
  }

  /// Checks a value for a parameter. Errors: Invalid.
  [[nodiscard]] Status check_parameter(const std::string& parameter,
                                       const std::string& value) const;

  /// Whether a new value needs a restart: the parameter is fixed, or the module takes no commands.
  [[nodiscard]] bool is_fixed(const std::string& parameter) const {
    const auto found = known.find(parameter);
    return control_uri.empty() || (found != known.end() && found->second.options.fixed);
  }

  /// Program and arguments.
  [[nodiscard]] std::vector<std::string> command() const;
};

/// A link. Its ends are also in PlannedModule::ends of its modules, with the same port and URI.
struct PlannedLink {
  std::string from, to;                       ///< "MODULE.PORT", or a URI outside the graph
  std::string sender_uri, reader_uri;         ///< empty: the end is outside
  std::string keep;                           ///< policy for a slow reader
  std::map<std::string, std::string> policy;  ///< the other keys: `rate` and so on
  bool reconnects = false;  ///< its reader reconnects to its writer's next process

  /// One of its ends, without its route.
  [[nodiscard]] PlannedEnd end(bool is_input) const {
    const std::string& name = is_input ? to : from;
    return {is_input, name.substr(name.find('.') + 1), is_input ? reader_uri : sender_uri, {}};
  }
};

struct Plan {
  std::vector<PlannedModule> modules;
  std::vector<PlannedLink> links;
  std::string token;                              ///< as given
  std::map<std::string, std::int64_t> modes;      ///< numbers of modes, by name
  std::map<std::string, std::int64_t> sources;    ///< `src` of outputs, by "MODULE.PORT"
  std::map<std::string, std::int64_t> addresses;  ///< of inputs that have one, by "MODULE.PORT"
  std::set<std::string> workspaces;               ///< modules that publish the focus
  std::vector<std::string> unlinked;              ///< outputs without a link, "MODULE.PORT"
  std::vector<std::string> warnings;              ///< as Problems::warnings()
  /// Reserved for links over TCP, by link name, while any plan holds them.
  std::map<std::string, std::shared_ptr<const HeldPort>> ports;
  std::string frames;  ///< as text (G31), with the names of the file
};

/// Checks that a program outside may send to an input "MODULE.PORT" of a running graph: its
/// messages neither move anything nor decide on the focus, unless a task makes them its own.
/// Errors: Invalid.
Status check_feed(const Plan& plan, const std::string& input);

/// Edges from modules to the receivers of their messages.
using Edges = std::map<std::string, std::set<std::string>>;

/// The modules reachable from `modules`, including these.
std::set<std::string> reach(const Edges& edges, std::set<std::string> modules);

/// Returns the output of `program --describe` on a host (empty: the host of `hc run`).
using Describe =
    std::function<Result<std::string>(const std::string& program, const std::string& host)>;

/// Reserves a port for a link over TCP on its writer's host: of 127.0.0.1, or of all addresses for
/// a reader on another host.
using HoldPort = std::function<Result<std::shared_ptr<const HeldPort>>(const std::string& host,
                                                                       bool is_for_others)>;

/// Addresses and key of a host, for links to and from it.
struct HostPlace {
  std::string address;      ///< for connections from other hosts
  std::string runner;       ///< for its connections to the host of `hc run`
  std::string fingerprint;  ///< of its key, which is made for one run
};
/// By name; the host of `hc run` (empty) needs only the fingerprint.
using HostPlaces = std::map<std::string, HostPlace>;

/// The key of a module's host, for links to other hosts, is open in the module as this descriptor.
inline constexpr int kKeyDescriptor = 3;
inline constexpr std::string_view kKeyFile = "/proc/self/fd/3";

/// Checks a graph and plans it.
///
/// A link's name is made of its ends and stays the same when the graph is planned again. Ports
/// without an address get the lowest free ones, in the order of the file.
///
/// @param token  unique among running graphs; the prefix of all link names.
/// @param before  an earlier plan of this graph whose addresses and TCP ports stay, so that
/// unchanged modules are planned as before; null: none.
/// @param hold_port  empty: links over TCP get port 0, and the plan cannot be run.
/// @param places  of the hosts that run modules.
///
/// Problems: see spec/graph.md. None for a graph that is not whole, whose missing files may declare
/// any name, and no more for a module whose program is empty, which has been reported. With
/// problems, do not use the plan.
Plan make_plan(Graph graph, const Describe& describe, std::string_view token, Problems& problems,
               const Plan* before = nullptr, const HoldPort& hold_port = {},
               const HostPlaces& places = {});

}  // namespace hc
