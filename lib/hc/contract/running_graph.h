// SPDX-License-Identifier: Apache-2.0
#pragma once
// A running graph as others name it, and the two sockets that it listens at: one sends its state
// and its log, the other takes commands (spec/graph.md, G45 … G47). Pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hc {

/// The characters of a graph's name, and its greatest length. [byte]
bool is_of_graph_name(char c);
inline constexpr std::size_t kMaxGraphName = 40;

/// A graph that runs: one `hc run`.
struct RunningGraph {
  /// What its sockets' names begin with, in the abstract namespace.
  static constexpr std::string_view kPrefix = "hypercolumn.";

  std::string name;
  int process = 0;  ///< of `hc run`

  /// "NAME.PROCESS"
  [[nodiscard]] std::string text() const { return name + "." + std::to_string(process); }
  [[nodiscard]] std::string socket_name() const { return std::string(kPrefix) + text(); }
  /// Where its states and its log are read.
  [[nodiscard]] std::string state_uri() const { return "unix:@" + socket_name(); }
  /// Where it takes commands.
  [[nodiscard]] std::string command_uri() const { return state_uri() + ".ask"; }
};

/// The src of what a graph sends: its state, one line of JSON, and a line of its log.
enum class GraphReport : std::int32_t { State = 1, Log };
/// The longest of these that is read, and the longest message of commands. [byte]
inline constexpr std::uint64_t kMaxStateBytes = std::uint64_t{16} << 20;
inline constexpr std::uint64_t kMaxCommandBytes = std::uint64_t{1} << 20;

/// "NAME.PROCESS"; nothing of any other text, such as the names of other programs' sockets.
std::optional<RunningGraph> parse_running_graph(std::string_view text);

}  // namespace hc
