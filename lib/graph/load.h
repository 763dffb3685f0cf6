// SPDX-License-Identifier: Apache-2.0
#pragma once
// From a graph file to a plan: reads the files, finds the programs, asks for their descriptions,
// and checks everything.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/plan.h>

namespace hc {

/// A graph file and the options of `hc run` that affect its plan.
struct LoadOptions {
  std::string file;
  std::vector<std::string> settings;  ///< MODULE.PARAMETER=VALUE
  bool page = false;                  ///< adds a module `web`, which opens a browser
  std::string listen;                 ///< address on which `web` listens; empty: its default
  /// Parameters of an added module `recorder` that records outputs; empty: none.
  std::map<std::string, std::string> recorder = {};
  std::string token;         ///< for make_plan()
  bool holds_ports = false;  ///< reserves ports for links over TCP; needed to run the plan
  /// Takes programs of other hosts from this one, which needs none of them: for a plan that is only
  /// looked at, or run here.
  bool programs_here = false;
  /// Connects to other hosts; null: graphs with hosts are refused. Must outlive the loader.
  Hosts* hosts = nullptr;
};

/// A graph that has been read and checked.
struct LoadedGraph {
  Graph graph;                        ///< with the paths of its programs
  std::optional<Plan> plan;           ///< nullopt: see `problems`
  std::vector<std::string> problems;  ///< one line each
  std::string recorder;               ///< the module added for LoadOptions::recorder; empty: none
  bool awaits_hosts = false;          ///< the only problems are hosts that are out of reach
};

/// Loads one graph, repeatedly while it runs. Not thread-safe.
class GraphLoader {
 public:
  virtual ~GraphLoader() = default;

  /// Reads the graph's files and plans it.
  ///
  /// @param running  the plan that runs, whose numbers stay; null: none. Without it, call this on
  /// the thread of the hosts' loop, which it turns; otherwise on another thread.
  /// @param stop  readable when waiting for programs must end.
  ///
  /// Errors: NotFound (the file), Stopped, System (unreadable file; no descriptor or thread left).
  /// Everything else is in LoadedGraph::problems.
  virtual Result<LoadedGraph> load(const Plan* running, int stop) = 0;

  /// Plans a loaded graph that has been edited.
  virtual LoadedGraph plan(Graph graph, const Plan& running, int stop) = 0;
};

/// A loader that asks a program for its description once, and again when its file changes.
std::unique_ptr<GraphLoader> make_loader(LoadOptions options);

/// A LoadOptions::token that is unique among running graphs.
std::string graph_token();

}  // namespace hc
