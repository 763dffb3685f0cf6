// SPDX-License-Identifier: Apache-2.0
#include <graph/global_workspace.h>

#include <algorithm>
#include <vector>

namespace hc {
namespace {

/// The mode in focus, by workspace.
using Focus = std::map<std::string, std::string>;

/// A link between two modules that work in the current modes.
struct Edge {
  std::size_t link;
  std::string from, to;
  bool is_exclusive;  // ends at an exclusive input
};

bool is_in_focus(const PlannedModule& module, const Focus& focus) {
  const auto mode = focus.find(module.workspace);
  return mode != focus.end() && !module.mode.empty() && module.mode == mode->second;
}

bool works(const PlannedModule& module, const Focus& focus) {
  if (!module.mode.empty()) return is_in_focus(module, focus);
  if (module.modes.empty()) return true;
  const auto mode = focus.find(module.workspace);
  return mode != focus.end() &&
         std::find(module.modes.begin(), module.modes.end(), mode->second) != module.modes.end();
}

std::vector<Edge> edges_in(const Plan& plan, const Focus& focus) {
  std::map<std::string_view, const PlannedModule*> modules;
  for (const auto& module : plan.modules) modules[module.name] = &module;
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < plan.links.size(); ++i) {
    const PlannedLink& link = plan.links[i];
    auto from_dot = link.from.find('.'), to_dot = link.to.find('.');
    auto from = modules.find(std::string_view(link.from).substr(0, from_dot));
    auto to = modules.find(std::string_view(link.to).substr(0, to_dot));
    if (from == modules.end() || to == modules.end()) continue;  // outside the graph
    const bool carries_focus = plan.workspaces.contains(from->second->name) &&
                               link.to == std::string(to->first) + ".focus";
    if (carries_focus || !works(*from->second, focus) || !works(*to->second, focus)) continue;
    edges.push_back({i, from->second->name, to->second->name,
                     to->second->exclusive.contains(link.to.substr(to_dot + 1))});
  }
  return edges;
}

}  // namespace

GlobalWorkspace global_workspace(const Plan& plan, const Focus& focus) {
  GlobalWorkspace workspace;
  const std::vector<Edge> edges = edges_in(plan, focus);
  Edges forward, backward;
  std::set<std::string> senders;  // to exclusive inputs
  for (const Edge& edge : edges) {
    forward[edge.from].insert(edge.to);
    backward[edge.to].insert(edge.from);
    if (edge.is_exclusive) senders.insert(edge.from);
  }
  const std::set<std::string> leads_to_action = reach(backward, senders);
  std::set<std::string> tasks;
  for (const auto& module : plan.modules)
    if (is_in_focus(module, focus) && leads_to_action.contains(module.name))
      tasks.insert(module.name);
  const std::set<std::string> before = reach(backward, tasks), behind = reach(forward, tasks);
  for (const Edge& edge : edges) {
    bool leads_to_task = before.contains(edge.to);
    bool leads_on =
        behind.contains(edge.from) && (edge.is_exclusive || leads_to_action.contains(edge.to));
    if (!leads_to_task && !leads_on) continue;
    workspace.links.insert(edge.link);
    workspace.modules.insert({edge.from, edge.to});
  }
  return workspace;
}

}  // namespace hc
