// SPDX-License-Identifier: Apache-2.0
#pragma once
// Graphs that run on this host, seen from outside: which there are, what they say of themselves,
// and what one asks them to do. spec/graph.md (G45 … G47) has their words.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <hc/link/link.h>

namespace tool {

/// Of what a graph's name is made, and how long it is at most. [byte]
bool is_of_graph_name(char c);
inline constexpr std::size_t kMaxGraphName = 40;

/// A graph that runs: one `hc run`.
struct RunningGraph {
  std::string name;
  int process = 0;

  [[nodiscard]] std::string text() const { return name + "." + std::to_string(process); }
};

/// Those of all users, by name and process number, from a table as /proc/net/unix is.
std::vector<RunningGraph> find_running(std::string_view sockets);
std::vector<RunningGraph> find_running();

/// The one that is meant: by its name, or NAME.PROCESS where several have that; empty: the only one
/// there is. Fails with what there is otherwise.
RunningGraph choose_running(const std::string& name);

/// Hears what a graph says.
class Observer {
 public:
  explicit Observer(const RunningGraph& graph);

  /// The next state; nothing when the graph has ended or we are to stop. Skips to the newest.
  /// @param input  descriptor that ends the wait too when it is readable, with an empty object; -1.
  std::optional<nlohmann::json> next(int input = -1);

  /// A state with the load of processors and memory, which a graph measures while it is watched.
  std::optional<nlohmann::json> next_measured();

 private:
  std::string name_;
  std::unique_ptr<hc::Source> source_;
};

/// Has a graph do what the commands say, a row each; fails with what it answers when that is not
/// "ok".
void ask(const RunningGraph& graph, const std::vector<std::string>& commands);

}  // namespace tool
