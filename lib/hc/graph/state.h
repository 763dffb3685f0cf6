// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a graph that runs is doing, at one moment, and that as JSON.

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/link/link.h>

namespace hc {

enum class ModuleStatus {
  Starting,  ///< has a process, of which nothing has been heard yet
  Running,
  Stalled,   ///< has stopped to report
  Waiting,   ///< to be started again
  Stopping,  ///< has been asked to end
  Ended,     ///< for good: its work is done, or it was asked to
  GivenUp,   ///< for good, though its work is not done
};
/// "running", "given up" and so on.
std::string_view name(ModuleStatus status);

struct ModuleState {
  std::string name, program;
  pid_t process = 0;  ///< 0: none
  ModuleStatus status = ModuleStatus::Starting;
  std::string detail;  ///< why, where the status alone does not tell
  int restarts = 0;
  std::optional<int> exit;         ///< status of the process that ended last
  double processor = 0;            ///< part of one processor, in the last period
  std::uint64_t memory = 0;        ///< PSS [byte]
  std::string mode;                ///< of a task; empty: none
  std::vector<std::string> modes;  ///< it works in; empty: all
  bool in_focus = true;
  bool in_workspace = false;
  std::map<std::string, std::string> parameters;
};

struct LinkState {
  std::string from, to;    ///< "MODULE.PORT", or a URI
  std::string transport;   ///< "shm", "unix", …
  std::string keep, rate;  ///< as the graph gives them; rate empty: none
  Traffic traffic;         ///< of its sender, with what its reader has lost
  /// Of what its reader has taken, where that tells.
  double per_second = 0, bytes_per_second = 0;
  std::uint64_t left_out = 0;                ///< not handled by its reader: out of focus
  std::optional<std::array<double, 3>> age;  ///< p50, p99, greatest [s]
  std::optional<std::array<double, 3>> gap;  ///< between messages, the same [s]
  bool in_workspace = false;
};

struct GraphState {
  std::string name, file;
  pid_t process = 0;  ///< of the runner
  double uptime = 0;  ///< [s]
  bool is_stopping = false;
  std::int64_t focus = 0;  ///< number of the mode in focus; 0: none
  std::vector<ModuleState> modules;
  std::vector<LinkState> links;
  std::map<std::string, std::int64_t> modes;      ///< their numbers
  std::map<std::string, std::int64_t> addresses;  ///< of inputs, "MODULE.PORT"

  /// Name of the mode in focus, its number where it has none; empty: none.
  [[nodiscard]] std::string focus_name() const;
};

/// The state as one line of JSON, as spec/graph.md describes it.
std::string to_json(const GraphState& state);

}  // namespace hc
