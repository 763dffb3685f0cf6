// SPDX-License-Identifier: Apache-2.0
#pragma once
// The outputs of a module that are open to observers. Internal to graph.

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/run/reports.h>
#include <hc/contract/command.h>

namespace hc::internal {

class ObservedOutputs {
 public:
  using Send = std::function<void(const ModuleCommand& command)>;

  /// @param hosts  null: the module runs on this host.
  /// @param send  sends a command to the module.
  ObservedOutputs(const Hosts* hosts, Send send) : hosts_(hosts), send_(std::move(send)) {}

  /// Opens an output, under a unique name; it is closed after kObserved without readers.
  ///
  /// @returns  the URI for observers. Errors: Closed (its host is not connected).
  Result<std::string> open(const PlannedModule& module, const std::string& port,
                           const std::string& name, MonotonicTime now);
  static constexpr std::chrono::seconds kObserved{5};

  /// Closes those that have had no readers.
  /// @param reports  null: its process restarts, and the readers wait for the next one.
  void close_unread(const Reports* reports, MonotonicTime now);

  /// The commands by which a new process opens them.
  [[nodiscard]] std::vector<ModuleCommand> links() const;

 private:
  struct Observed {
    PlannedEnd end;
    std::string uri;  // for observers
    MonotonicTime until{0};
    std::shared_ptr<const HeldPort> held = {};  // if the module is on another host
  };

  Status choose_uris(Observed& observed, const PlannedModule& module,
                     const std::string& name) const;

  const Hosts* hosts_;
  Send send_;
  std::map<std::string, Observed> observed_;  // by output
};

}  // namespace hc::internal
