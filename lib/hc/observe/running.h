// SPDX-License-Identifier: Apache-2.0
#pragma once
// Graphs that run on this host, seen from outside: which there are, commands to them, and their
// outputs read without disturbing them. spec/graph.md (G45 … G47) has their words.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/link/link.h>

namespace hc {

/// Of what a graph's name is made, and how long it is at most. [byte]
bool is_of_graph_name(char c);
inline constexpr std::size_t kMaxGraphName = 40;

/// A graph that runs: one `hc run`.
struct RunningGraph {
  std::string name;
  int process = 0;

  [[nodiscard]] std::string text() const { return name + "." + std::to_string(process); }
  /// Where it sends its states (src 1) and its log (src 2), and where it takes commands.
  [[nodiscard]] std::string state_uri() const;
  [[nodiscard]] std::string command_uri() const { return state_uri() + ".ask"; }
};

/// The src of what a graph sends: its state, one line of JSON, and a line of its log.
inline constexpr std::int32_t kStateSource = 1, kLogSource = 2;
/// The longest of these that is read. [byte]
inline constexpr std::uint64_t kMaxStateBytes = std::uint64_t{16} << 20;
/// A graph that has said nothing for so long may be stopped: it speaks twice a second.
inline constexpr std::chrono::milliseconds kSilence{5000};

/// "NAME.PROCESS"; nothing where it is none, such as what anybody may bind.
std::optional<RunningGraph> parse_running(std::string_view text);

/// The graph that this program is a module of, from HC_GRAPH, which `hc run` sets; nothing outside
/// a graph.
std::optional<RunningGraph> own_graph();

/// Those of all users, by name and process number, from a table as /proc/net/unix is; and those of
/// this user, as which who listens there is known by the kernel.
std::vector<RunningGraph> find_running(std::string_view sockets);
std::vector<RunningGraph> find_running();

/// What a graph has answered.
struct Answer {
  bool is_ok = false;
  std::vector<std::string> rows;  ///< behind "ok", or what is wrong, at least one then
};

/// Has a graph do what the commands say, a row each, all of them or none.
///
/// @param stop  descriptor that is readable when waiting is to end; -1: none.
/// Errors: Closed (the graph has ended or does not answer), Stopped, System.
/// Cost: waits for the answer, up to 2 minutes while the graph is alive.
Result<Answer> ask(const RunningGraph& graph, const std::vector<std::string>& commands,
                   int stop = -1);

/// An output that a graph holds open for observers, while it is asked so once in 5 s.
class Observation {
 public:
  /// @param port  MODULE.PORT; of an input, what feeds it.
  /// Errors: Invalid (there is no such port), as ask().
  static Result<Observation> make(const RunningGraph& graph, const std::string& port,
                                  int stop = -1);

  /// What to read; the link outlives restarts of the module.
  [[nodiscard]] const std::string& uri() const { return uri_; }
  /// Asks for more time; false when the graph has ended.
  bool renew();

 private:
  std::string command_, uri_;
  std::unique_ptr<Sink> sink_;
};

}  // namespace hc
