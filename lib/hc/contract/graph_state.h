// SPDX-License-Identifier: Apache-2.0
#pragma once
// A snapshot of a running graph, as a struct and as JSON.

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
  Starting,  ///< its process has not reported yet
  Running,
  Stalled,   ///< has stopped reporting
  Waiting,   ///< to be restarted
  Stopping,  ///< has been asked to end
  Ended,     ///< for good: finished, or as asked
  GivenUp,   ///< failed too often
};
/// "running", "given up" and so on.
std::string_view name(ModuleStatus status);

struct ModuleState {
  std::string name, program;
  std::string host;   ///< empty: that of `hc run`
  std::string group;  ///< the included graph that it belongs to; empty: none
  pid_t process = 0;  ///< 0: none
  ModuleStatus status = ModuleStatus::Starting;
  std::string detail;  ///< explains the status, where necessary
  int restarts = 0;
  std::optional<int> exit;         ///< exit status of its last process
  double processor = 0;            ///< load in the last period, 1: one processor
  std::uint64_t memory = 0;        ///< PSS [byte]
  std::string mode;                ///< of a task; empty: none
  std::vector<std::string> modes;  ///< in which it is active; empty: all
  std::string workspace;           ///< that it belongs to; empty: none
  std::string last_line;           ///< of its log
  Level last_level = Level::Info;
  double last_line_age = 0;  ///< [s]
  bool in_focus = true;
  bool in_workspace = false;
  std::string waits_for;        ///< the input whose reader blocks it; empty: unknown
  std::optional<double> waits;  ///< blocked for [s]; nullopt: not blocked
  std::map<std::string, std::string> parameters;
};

/// Statuses of a link to the outside: its module has not opened it, or nothing is at its other end.
inline constexpr const char *kNotOpen = "not open", *kNotConnected = "not connected";

struct LinkState {
  std::string from, to;   ///< "MODULE.PORT", or a URI
  std::string transport;  ///< "shm", "unix", …
  std::string status;     ///< why it is down: "camera: waiting"; empty: it is up
  std::string keep;       ///< as in the graph file
  double rate = 0;        ///< limit [message/s]; 0: none
  double bandwidth = 0;   ///< limit [byte/s]; 0: none
  /// Quality of JPEG and scale of images, as they are adapted to the bandwidth.
  std::optional<std::array<double, 2>> images;
  Traffic traffic;  ///< of the sender, plus the reader's drops
  /// As measured by the reader, or by the sender if the reader reports nothing.
  double per_second = 0, bytes_per_second = 0;
  std::uint64_t ignored = 0;                 ///< by the reader, because it was out of focus
  std::optional<std::array<double, 3>> age;  ///< latency: median, p99, maximum [s]
  std::optional<std::array<double, 3>> gap;  ///< inter-arrival time: median, p99, maximum [s]
  bool in_workspace = false;
};

/// Another host with modules of the graph. Clocks are compared twice a second.
struct HostState {
  std::string name;
  bool is_connected = false;
  std::string detail;             ///< why it is not connected
  std::optional<double> offset;   ///< its wall clock minus that of the host of `hc run` [s]
  std::optional<double> error;    ///< bound on the error of the offset and of its times [s]
  std::optional<double> drift;    ///< rate of its monotonic clock relative to the runner's host
  std::optional<double> latency;  ///< round-trip time [s]
};

struct GraphState {
  std::string name, file;
  pid_t process = 0;  ///< of the runner
  double uptime = 0;  ///< [s]
  bool is_stopping = false;
  std::map<std::string, std::int64_t> focus;  ///< mode in focus of each workspace; 0: none
  /// Workspaces that have been stopped, and the sources that did it.
  std::map<std::string, std::vector<std::string>> stopped;
  std::vector<HostState> hosts;
  std::vector<ModuleState> modules;
  std::vector<LinkState> links;
  std::map<std::string, std::int64_t> modes;      ///< numbers by name
  std::map<std::string, std::int64_t> addresses;  ///< of inputs, "MODULE.PORT"

  /// The name of a mode, or its number if it has none; empty for 0.
  [[nodiscard]] std::string mode_name(std::int64_t number) const;
  /// The name of the mode in focus in a module's workspace; empty: none.
  [[nodiscard]] std::string focus_of(const ModuleState& module) const;
  /// The modes in focus: "track", or for several workspaces "left: track, right: none"; empty: no
  /// workspace has one.
  [[nodiscard]] std::string focus_in_words() const;
  /// "stopped by web.stop, hands.stop", or with several workspaces "stopped: left by web.stop;
  /// right by hands.stop"; empty: none is stopped.
  [[nodiscard]] std::string stopped_in_words() const;
};

/// The state as one line of JSON (spec/graph.md).
std::string to_json(const GraphState& state);

/// Errors: Malformed.
Result<GraphState> parse_graph_state(std::string_view json);

}  // namespace hc
