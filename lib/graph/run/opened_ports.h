// SPDX-License-Identifier: Apache-2.0
#pragma once
// The ports of a module that are open to programs outside the graph. Internal to graph.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <graph/hosts.h>
#include <graph/run/reports.h>
#include <hc/contract/command.h>

namespace hc::internal {

/// Outputs that are open to observers, and inputs that are open to senders.
class OpenedPorts {
 public:
  using Send = std::function<void(const ModuleCommand& command)>;

  /// @param hosts  null: the module runs on this host.
  /// @param send  sends a command to the module.
  OpenedPorts(const Hosts* hosts, Send send) : hosts_(hosts), send_(std::move(send)) {}

  /// Opens a port, under a unique name; it is closed after kOpen without peers.
  ///
  /// @returns  the URI for programs outside. Errors: Closed (its host is not connected).
  Result<std::string> open(const PlannedModule& module, bool is_input, const std::string& port,
                           const std::string& name, MonotonicTime now);
  static constexpr std::chrono::seconds kOpen{5};

  /// Closes those that have had no peers.
  /// @param reports  null: its process restarts, and the peers wait for the next one.
  void close_unused(const Reports* reports, MonotonicTime now);

  /// The commands by which a new process opens them.
  [[nodiscard]] std::vector<ModuleCommand> links() const;

 private:
  struct Opened {
    PlannedEnd end;
    std::string uri;  // for programs outside
    MonotonicTime until{0};
    std::shared_ptr<const HeldPort> held = {};  // if the module is on another host
  };

  Status choose_uris(Opened& opened, const PlannedModule& module, const std::string& name) const;

  const Hosts* hosts_;
  Send send_;
  std::map<std::pair<bool, std::string>, Opened> opened_;  // by `is_input` and port
};

}  // namespace hc::internal
