// SPDX-License-Identifier: Apache-2.0
#pragma once
// From the name of a graph file to a plan: reads the files, finds the programs, asks them for their
// descriptions, and checks all of it.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/plan.h>

namespace hc {

/// Which graph, and what is set beside its file.
struct LoadOptions {
  std::string file;
  std::vector<std::string> settings;  ///< MODULE.PARAMETER=VALUE
  bool page = false;                  ///< has a module `web`, which opens a browser
  std::string listen;                 ///< address that it listens on; empty: its own
  /// Parameters of a module `recorder` that records all outputs; empty: there is none.
  std::map<std::string, std::string> recorder = {};
  std::string token;         ///< for make_plan()
  bool holds_ports = false;  ///< that links over TCP need, where the plan is to run
  /// Connects to other hosts; null: a graph that has such is refused. Must outlive the loader.
  Hosts* hosts = nullptr;
};

/// A graph that has been read and checked.
struct LoadedGraph {
  Graph graph;                        ///< with the paths of its programs
  std::optional<Plan> plan;           ///< nothing: it cannot run, and `problems` say why
  std::vector<std::string> problems;  ///< lines
  std::string recorder;               ///< module added for LoadOptions::recorder; empty: none
};

/// Loads one graph, again and again while it runs. Not for two threads at once.
class GraphLoader {
 public:
  virtual ~GraphLoader() = default;

  /// Reads the files of the graph as they are now, and plans it.
  ///
  /// @param running  the plan by which it runs, whose numbers stay; null: it does not run. Then
  /// it is called on the thread of the hosts' loop and turns that; else on another one.
  /// @param stop  descriptor that is readable when no program is to be waited for any more.
  ///
  /// Errors: NotFound (the file), Stopped, System (it cannot be read; no descriptor or thread to be
  /// had). All else that is wrong is in LoadedGraph::problems.
  virtual Result<LoadedGraph> load(const Plan* running, int stop) = 0;

  /// Plans a graph that was loaded and has been changed.
  virtual LoadedGraph plan(Graph graph, const Plan& running, int stop) = 0;
};

/// A loader that asks each program once for its description, and again when its file changes.
std::unique_ptr<GraphLoader> make_loader(LoadOptions options);

/// A word for LoadOptions::token that no other running graph has.
std::string graph_token();

}  // namespace hc
