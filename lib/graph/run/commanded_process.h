// SPDX-License-Identifier: Apache-2.0
#pragma once
// The process of a module, on the host of its plan, and the commands that it has got. Internal to
// graph.

#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/module_process.h>
#include <graph/run/change.h>
#include <graph/run/opened_ports.h>
#include <hc/os/loop.h>

namespace hc::internal {

class CommandedProcess {
 public:
  /// @param hosts  null: it runs on this host. @param plan  of the module; must outlive it, and may
  /// change. @param callbacks  all but `connected`. @param opened  its open ports.
  CommandedProcess(Loop& loop, Hosts* hosts, const PlannedModule& plan, const OpenedPorts& opened,
                   ModuleCallbacks callbacks);
  CommandedProcess(const CommandedProcess&) = delete;

  /// Listens for reports where the plan says; does nothing if it does so already. Errors: Invalid,
  /// System (a name is in use).
  Status place();
  /// Whether the host of the plan is connected; of this host, always.
  [[nodiscard]] bool is_host_connected() const;

  /// Starts a process. @param plan  with the options of this start. Errors: System.
  Status start(PlannedModule plan);
  /// Ends it, measures it; once place() has succeeded.
  [[nodiscard]] ModuleProcess& process() const { return *process_; }

  /// The commands for another plan than the module's. A process that has not connected catches up
  /// when it does, so only the difference between the plans counts.
  [[nodiscard]] ModuleChange change_to(const PlannedModule& next) const;
  /// The plan has been changed, and the commands for that are sent.
  void note_change();
  /// Sends a command, unless the process will get it when it connects. False: it takes none.
  bool send(const ModuleCommand& command);
  /// The command that says whether an input's writer has ended for good; null: it knows.
  std::optional<ModuleCommand> finish_input(const PlannedEnd& end, bool is_finished);
  /// The command that corrects the clock of a process on another host; null: it is right.
  std::optional<ModuleCommand> correct_clock();

 private:
  [[nodiscard]] std::shared_ptr<Host> host_of_plan() const;
  [[nodiscard]] bool takes_commands() const { return !plan_.control_uri.empty(); }
  std::vector<Message> catch_up();
  void update_known();

  Loop& loop_;
  Hosts* hosts_;
  const PlannedModule& plan_;
  PlannedModule known_;  // the plan as known to the process, possibly with older URIs of links
  const OpenedPorts& opened_;
  ModuleCallbacks callbacks_;
  std::set<std::string> finished_;           // inputs whose writers have ended for good
  std::chrono::nanoseconds wall_offset_{0};  // last sent to a process on another host
  std::shared_ptr<Host> host_;               // null: this host
  std::unique_ptr<ModuleProcess> process_;
};

}  // namespace hc::internal
