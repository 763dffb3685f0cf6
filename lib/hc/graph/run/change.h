// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a module that runs is told so that it becomes as another plan wants it. Pure. Internal to
// graph.

#include <string>
#include <vector>

#include <hc/graph/plan.h>

namespace hc::internal {

struct ModuleChange {
  bool needs_restart = false;        ///< it cannot be told; the commands play no part then
  std::vector<std::string> unlinks;  ///< commands that are told before all modules' others
  std::vector<std::string> settings, outputs, inputs;

  [[nodiscard]] bool is_empty() const {
    return !needs_restart && unlinks.empty() && settings.empty() && outputs.empty() &&
           inputs.empty();
  }
};

/// Whether two ends are the same link's: how many readers a writer waits for at its start plays no
/// part.
bool is_same_end(const PlannedEnd& one, const PlannedEnd& other);

/// @param before  with the ends as the process has been told them.
ModuleChange change_between(const PlannedModule& before, const PlannedModule& after);

}  // namespace hc::internal
