// SPDX-License-Identifier: Apache-2.0
#pragma once
// The modules of a running graph, and their neighbours by the links of its plan. Internal to graph.

#include <map>
#include <memory>
#include <set>
#include <string>

#include <graph/plan.h>
#include <graph/run/supervised.h>

namespace hc::internal {

class RunningModules {
 public:
  using ByName = std::map<std::string, std::unique_ptr<Supervised>>;

  /// @param plan  of the graph; must outlive it, and may change.
  explicit RunningModules(const Plan& plan) : plan_(plan) {}

  [[nodiscard]] Supervised* find(const std::string& name) const;
  /// The module of "MODULE.PORT"; null outside the graph.
  [[nodiscard]] Supervised* at(const std::string& end) const;
  [[nodiscard]] const ByName& all() const { return modules_; }

  /// The modules that end, temporarily, when a module ends: its neighbours without `control`, and
  /// transitively theirs, in any order.
  [[nodiscard]] std::set<Supervised*> cut_off_by(const std::string& name) const;
  /// Whether some writer of a module's inputs (if it has none: some reader) has not ended for good.
  [[nodiscard]] bool has_work(const std::string& name) const;
  /// Whether all have run.
  [[nodiscard]] bool have_run() const;
  /// Whether all have ended for good, also those that are leaving.
  [[nodiscard]] bool are_over() const;

  Supervised& insert(const std::string& name, std::unique_ptr<Supervised> module);
  /// Ends a module that is no longer in the plan; it leaves when its process has ended.
  void let_go(const std::string& name);
  /// A module that is leaving, among the others again; null if there is none of that name.
  Supervised* bring_back(const std::string& name);
  /// Destroys those that have left.
  void forget_left();

 private:
  const Plan& plan_;
  ByName modules_, leaving_;
};

}  // namespace hc::internal
