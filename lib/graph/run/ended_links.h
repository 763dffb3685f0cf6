// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the end of a module means for the modules at its links. Internal to graph.

#include <map>
#include <memory>
#include <string>
#include <utility>

#include <graph/run/graph_log.h>
#include <graph/run/running_modules.h>
#include <hc/os/loop.h>

namespace hc::internal {

/// Makes sure that no module waits for a reader or writer that has ended for good.
class EndedLinks {
 public:
  /// @param hosts  null: all modules run on this host. All must outlive it.
  EndedLinks(Loop& loop, Hosts* hosts, const Plan& plan, const RunningModules& modules,
             GraphLog& log)
      : loop_(loop), hosts_(hosts), plan_(plan), modules_(modules), log_(log) {}

  /// Finishes inputs without writers, reads in place of readers, and ends modules without readers.
  void settle();

 private:
  using LinkName = std::pair<std::string, std::string>;  // from, to

  void end_unneeded();
  [[nodiscard]] Result<std::shared_ptr<void>> drain_for(const PlannedModule& reader,
                                                        const std::string& uri) const;

  Loop& loop_;
  Hosts* hosts_;
  const Plan& plan_;
  const RunningModules& modules_;
  GraphLog& log_;
  std::map<LinkName, std::shared_ptr<void>> drains_;  // replace ended readers; null: it failed
};

}  // namespace hc::internal
