// SPDX-License-Identifier: Apache-2.0
#pragma once
// The commands that change a running module to another plan. Pure. Internal to graph.

#include <vector>

#include <graph/plan.h>
#include <hc/contract/command.h>

namespace hc::internal {

struct ModuleChange {
  bool needs_restart = false;  ///< commands cannot do it; they are empty
  /// In the order in which to send them, each to all modules before the next: removed links, then
  /// new parameters and outputs, then new inputs.
  std::vector<ModuleCommand> unlinks, outputs, inputs;

  [[nodiscard]] bool is_empty() const {
    return !needs_restart && unlinks.empty() && outputs.empty() && inputs.empty();
  }
};

/// Whether two ends are of the same link, ignoring the option `readers`.
bool is_same_end(const PlannedEnd& one, const PlannedEnd& other);

/// @param before  with the ends as known to the process.
ModuleChange change_between(const PlannedModule& before, const PlannedModule& after);

}  // namespace hc::internal
