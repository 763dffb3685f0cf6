// SPDX-License-Identifier: Apache-2.0
// Warns of graphs that may move a robot badly: links on which an uninvolved module can block one
// that controls the robot, and loops through two actors or workspaces.
#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <set>

#include <graph/plan/planning.h>

namespace hc::internal {
namespace {

/// The shortest path of one or more edges, with both ends; empty: none. Cost: linear in the edges.
std::vector<std::string> find_path(const Edges& edges, const std::string& from,
                                   const std::string& to) {
  std::map<std::string, std::string> before;
  std::deque<std::string> next = {from};
  while (!next.empty() && !before.contains(to)) {
    const std::string module = next.front();
    next.pop_front();
    if (const auto receivers = edges.find(module); receivers != edges.end())
      for (const auto& receiver : receivers->second)
        if (before.emplace(receiver, module).second) next.push_back(receiver);
  }
  if (!before.contains(to)) return {};
  std::vector<std::string> path = {to};
  do path.push_back(before.at(path.back()));
  while (path.back() != from);
  std::reverse(path.begin(), path.end());
  return path;
}

class MotionCheck {
 public:
  explicit MotionCheck(Planning& planning) : planning_(planning) {
    for (const auto& link : planning.graph.links) {
      if (!link.from.uri.empty() || !link.to.uri.empty()) continue;
      const Description* to = planning.description_of(link.to.module);
      const PortDescription* input = to == nullptr ? nullptr : find_input(*to, link.to.port);
      if (input == nullptr) continue;
      if (input->actor) actors_.insert(link.to.module);
      const bool is_frames = link.to.port == "frames" && takes_frames(planning, link.to.module);
      if (is_frames || planning.routes(link.from)) continue;
      auto& edges = input == &focus_input() ? focus_ : links_;
      edges[link.from.module].insert(link.to.module);
    }
  }

  void warn_of_loops() {
    // Motion changes what a robot's sensors see: an actor affects all modules of its own graph.
    Edges effects = links_;
    for (const auto& actor : actors_)
      if (const auto& group = group_of(actor); !group.empty())
        for (const auto& module : planning_.graph.modules)
          if (module.group == group) effects[actor].insert(module.name);
    warn_of_loops_over(actors_, links_, "actors", false);
    warn_of_loops_over(actors_, effects, "robots", true);
    Edges decisions = links_;
    for (const auto& [from, to] : focus_) decisions[from].insert(to.begin(), to.end());
    warn_of_loops_over(planning_.plan.workspaces, decisions, "workspaces", false);
  }

  /// Expects the links of the plan in the order of the graph.
  void warn_of_holds() {
    const auto moving = moving_modules();
    for (std::size_t i = 0; i < planning_.graph.links.size(); ++i) {
      const GraphLink& link = planning_.graph.links[i];
      const bool is_file = link.to.uri.starts_with("file:");
      if (!link.from.uri.empty() || is_file || planning_.plan.links[i].keep != "all") continue;
      if (!moving.contains(link.from.module) || moving.contains(link.to.module)) continue;
      planning_.problems.warn(link.place,
                              link.to.text() + " can block " + link.from.module +
                                  ", which controls the robot or its focus: " + link.from.text() +
                                  " waits for a slow reader; set keep = \"latest\" or a number");
    }
  }

 private:
  [[nodiscard]] const std::string& group_of(const std::string& name) const {
    return planning_.graph.find(name)->group;
  }

  /// The actors, the workspaces, and all modules whose messages lead to them.
  [[nodiscard]] std::set<std::string> moving_modules() const {
    Edges back;
    for (const auto& [from, to] : links_)
      for (const auto& module : to) back[module].insert(from);
    std::set<std::string> moving = actors_;
    moving.insert(planning_.plan.workspaces.begin(), planning_.plan.workspaces.end());
    return reach(back, std::move(moving));
  }

  /// Warns once of each pair of modules on a common loop.
  void warn_of_loops_over(const std::set<std::string>& modules, const Edges& edges,
                          const std::string& what, bool of_different_graphs) {
    for (auto one = modules.begin(); one != modules.end(); ++one)
      for (auto other = std::next(one); other != modules.end(); ++other) {
        if (of_different_graphs && group_of(*one) == group_of(*other)) continue;
        const auto there = find_path(edges, *one, *other);
        const auto back = there.empty() ? there : find_path(edges, *other, *one);
        if (back.empty() || !warned_.insert({*one, *other}).second) continue;
        std::string text = *one;
        for (const auto* path : {&there, &back})
          for (auto module = path->begin() + 1; module != path->end(); ++module)
            text += " -> " + *module;
        planning_.problems.warn(planning_.graph.find(*one)->place,
                                "loop over two " + what + ": " + text +
                                    "; they can disturb each other: cut the loop, or let one "
                                    "workspace decide");
      }
  }

  Planning& planning_;
  std::set<std::string> actors_;
  Edges links_, focus_;
  std::set<std::pair<std::string, std::string>> warned_;
};

}  // namespace

void check_motion(Planning& planning) {
  MotionCheck check(planning);
  check.warn_of_loops();
  check.warn_of_holds();
}

}  // namespace hc::internal
