// SPDX-License-Identifier: Apache-2.0
#pragma once
// Names of a running graph and of its two sockets: one publishes its state and log, the other takes
// commands (spec/graph.md, G45 … G47). Pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hc {

/// The characters of a graph's name, and its maximum length. [byte]
bool is_of_graph_name(char c);
inline constexpr std::size_t kMaxGraphName = 40;

/// A running graph: one `hc run`.
struct RunningGraph {
  /// Prefix of its sockets' names in the abstract namespace.
  static constexpr std::string_view kPrefix = "hypercolumn.";

  std::string name;
  int process = 0;  ///< of `hc run`

  /// "NAME.PROCESS"
  [[nodiscard]] std::string text() const { return name + "." + std::to_string(process); }
  [[nodiscard]] std::string socket_name() const { return std::string(kPrefix) + text(); }
  /// Publishes states and log.
  [[nodiscard]] std::string state_uri() const { return "unix:@" + socket_name(); }
  /// Takes commands.
  [[nodiscard]] std::string command_uri() const { return state_uri() + ".ask"; }
};

/// The src of a graph's messages: its state, one line of JSON, or a line of its log.
enum class GraphReport : std::int32_t { State = 1, Log };
/// The longest of these messages that is read, and the longest message of commands. [byte]
inline constexpr std::uint64_t kMaxStateBytes = std::uint64_t{16} << 20;
inline constexpr std::uint64_t kMaxCommandBytes = std::uint64_t{1} << 20;

/// Parses "NAME.PROCESS"; nullopt for other texts, such as names of unrelated sockets.
std::optional<RunningGraph> parse_running_graph(std::string_view text);

}  // namespace hc
