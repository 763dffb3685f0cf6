// SPDX-License-Identifier: Apache-2.0
#pragma once
// The commands that make a running module as another plan says. Pure. Internal to graph.

#include <vector>

#include <graph/plan.h>
#include <hc/contract/command.h>

namespace hc::internal {

struct ModuleChange {
  bool needs_restart = false;  ///< commands cannot make it so, and there are none
  /// Commands: those of all modules that remove links come first; then those that set parameters
  /// and add outputs; then those that add inputs.
  std::vector<ModuleCommand> unlinks, outputs, inputs;

  [[nodiscard]] bool is_empty() const {
    return !needs_restart && unlinks.empty() && outputs.empty() && inputs.empty();
  }
};

/// Whether two ends are of the same link, whatever number of readers a writer waits for at first.
bool is_same_end(const PlannedEnd& one, const PlannedEnd& other);

/// @param before  with the ends as the process knows them.
ModuleChange change_between(const PlannedModule& before, const PlannedModule& after);

}  // namespace hc::internal
