// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a running graph does, at one moment, as a struct and as JSON.

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/result.h>
#include <hc/base/traffic.h>
#include <hc/contract/log_line.h>

namespace hc {

enum class ModuleStatus {
  Starting,  ///< has a process that has not reported yet
  Running,
  Stalled,   ///< does not report any more
  Waiting,   ///< for its restart
  Stopping,  ///< has been asked to end
  Ended,     ///< for good: its work is done, or it was asked to
  GivenUp,   ///< failed too often
};
/// "running", "given up" and so on.
std::string_view name(ModuleStatus status);

struct ModuleState {
  std::string name, program;
  std::string host;   ///< empty: that of `hc run`
  std::string group;  ///< the included graph that it is of; empty: none
  pid_t process = 0;  ///< 0: none
  ModuleStatus status = ModuleStatus::Starting;
  std::string detail;  ///< the reason, where the status alone does not say it
  int restarts = 0;
  std::optional<int> exit;         ///< exit status of its last process
  double processor = 0;            ///< share of one processor, in the last period
  std::uint64_t memory = 0;        ///< PSS [byte]
  std::string mode;                ///< of a task; empty: none
  std::vector<std::string> modes;  ///< in which it is active; empty: all
  std::string workspace;           ///< whose focus it obeys; empty: none
  std::string last_line;           ///< of its log
  Level last_level = Level::Info;
  double last_line_age = 0;  ///< [s]
  bool in_focus = true;
  bool in_workspace = false;
  std::string waits_for;        ///< the input whose reader it waits for; empty: unknown
  std::optional<double> waits;  ///< since when [s]; nothing: it does not wait
  std::map<std::string, std::string> parameters;
};

struct LinkState {
  std::string from, to;   ///< "MODULE.PORT", or a URI
  std::string transport;  ///< "shm", "unix", …
  std::string status;     ///< why nothing can go over it: "camera: waiting"; else empty
  std::string keep;       ///< as the graph says
  double rate = 0;        ///< limit [message/s]; 0: none
  Traffic traffic;        ///< of its sender, and what was dropped at its reader
  /// At its reader, or at its sender where the reader reports nothing.
  double per_second = 0, bytes_per_second = 0;
  std::uint64_t ignored = 0;                 ///< ignored by its reader: out of focus
  std::optional<std::array<double, 3>> age;  ///< latency: median, p99, maximum [s]
  std::optional<std::array<double, 3>> gap;  ///< inter-arrival time, the same [s]
  bool in_workspace = false;
};

/// Another host that modules run on. Clocks are compared twice a second.
struct HostState {
  std::string name;
  bool is_connected = false;
  std::string detail;             ///< why not
  std::optional<double> offset;   ///< its wall clock less that of the host of `hc run` [s]
  std::optional<double> error;    ///< of that and of times that it sends, at most [s]
  std::optional<double> drift;    ///< of its monotonic clock against the other
  std::optional<double> latency;  ///< there and back [s]
};

struct GraphState {
  std::string name, file;
  pid_t process = 0;  ///< of the runner
  double uptime = 0;  ///< [s]
  bool is_stopping = false;
  std::map<std::string, std::int64_t> focus;  ///< of each workspace, the mode in focus; 0: none
  std::set<std::string> stopped;              ///< the workspaces that have been stopped
  std::vector<HostState> hosts;
  std::vector<ModuleState> modules;
  std::vector<LinkState> links;
  std::map<std::string, std::int64_t> modes;      ///< their numbers
  std::map<std::string, std::int64_t> addresses;  ///< of inputs, "MODULE.PORT"

  /// Name of a mode, its number where it has none; empty for 0.
  [[nodiscard]] std::string mode_name(std::int64_t number) const;
  /// Name of the mode that a module's workspace has in focus; empty: none.
  [[nodiscard]] std::string focus_of(const ModuleState& module) const;
  /// The modes in focus: "track", and of several workspaces "left: track, right: none"; empty: no
  /// workspace has one.
  [[nodiscard]] std::string focus_in_words() const;
  /// "stopped", and of several workspaces which, "stopped: left, right"; empty: none is.
  [[nodiscard]] std::string stopped_in_words() const;
};

/// The state as one line of JSON, as spec/graph.md describes it.
std::string to_json(const GraphState& state);

/// Errors: Malformed.
Result<GraphState> parse_graph_state(std::string_view json);

}  // namespace hc
