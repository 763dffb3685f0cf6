// SPDX-License-Identifier: Apache-2.0
// Warns of what a graph may do that moves a robot: links by which a module that does not matter to
// it may hold one that does, and loops that lead over two actors or workspaces.
#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <set>

#include <graph/plan/planning.h>

namespace hc::internal {
namespace {

/// The shortest way from one module to another over one step at least, with both its ends; empty:
/// there is none. Cost: linear in the steps there are.
std::vector<std::string> find_way(const Ways& ways, const std::string& from,
                                  const std::string& to) {
  std::map<std::string, std::string> before;
  std::deque<std::string> next = {from};
  while (!next.empty() && !before.contains(to)) {
    const std::string module = next.front();
    next.pop_front();
    if (const auto steps = ways.find(module); steps != ways.end())
      for (const auto& step : steps->second)
        if (before.emplace(step, module).second) next.push_back(step);
  }
  if (!before.contains(to)) return {};
  std::vector<std::string> way = {to};
  do way.push_back(before.at(way.back()));
  while (way.back() != from);
  std::reverse(way.begin(), way.end());
  return way;
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
      auto& ways = input == &focus_input() ? focus_ : links_;
      ways[link.from.module].insert(link.to.module);
    }
  }

  void warn_of_loops() {
    // Whoever is moved sees and hears something else then: an actor leads to all of its own graph.
    Ways ways = links_;
    for (const auto& actor : actors_)
      if (const auto& group = group_of(actor); !group.empty())
        for (const auto& module : planning_.graph.modules)
          if (module.group == group) ways[actor].insert(module.name);
    warn_of_loops_over(actors_, links_, "actors", false);
    warn_of_loops_over(actors_, ways, "robots", true);
    Ways decisions = links_;
    for (const auto& [from, to] : focus_) decisions[from].insert(to.begin(), to.end());
    warn_of_loops_over(planning_.plan.workspaces, decisions, "workspaces", false);
  }

  /// Links of the plan are in the order of the graph's.
  void warn_of_holds() {
    const auto moving = moving_modules();
    for (std::size_t i = 0; i < planning_.graph.links.size(); ++i) {
      const GraphLink& link = planning_.graph.links[i];
      const bool is_file = link.to.uri.starts_with("file:");
      if (!link.from.uri.empty() || is_file || planning_.plan.links[i].keep != "all") continue;
      if (!moving.contains(link.from.module) || moving.contains(link.to.module)) continue;
      planning_.problems.warn(
          link.place, link.to.text() + " can hold " + link.from.module +
                          ", which moves the robot or decides who does: " + link.from.text() +
                          " waits while it is slow; say keep = \"latest\", or a number");
    }
  }

 private:
  [[nodiscard]] const std::string& group_of(const std::string& name) const {
    return planning_.graph.find(name)->group;
  }

  /// The modules whose messages lead to an actor or a workspace, and these.
  [[nodiscard]] std::set<std::string> moving_modules() const {
    Ways back;
    for (const auto& [from, to] : links_)
      for (const auto& module : to) back[module].insert(from);
    std::set<std::string> moving = actors_;
    moving.insert(planning_.plan.workspaces.begin(), planning_.plan.workspaces.end());
    return reach(back, std::move(moving));
  }

  /// Of each two modules that a loop leads over, once.
  void warn_of_loops_over(const std::set<std::string>& modules, const Ways& ways,
                          const std::string& what, bool of_different_graphs) {
    for (auto one = modules.begin(); one != modules.end(); ++one)
      for (auto other = std::next(one); other != modules.end(); ++other) {
        if (of_different_graphs && group_of(*one) == group_of(*other)) continue;
        const auto there = find_way(ways, *one, *other);
        const auto back = there.empty() ? there : find_way(ways, *other, *one);
        if (back.empty() || !warned_.insert({*one, *other}).second) continue;
        std::string text = *one;
        for (const auto* way : {&there, &back})
          for (auto module = way->begin() + 1; module != way->end(); ++module)
            text += " -> " + *module;
        planning_.problems.warn(planning_.graph.find(*one)->place,
                                "loop over two " + what + ": " + text +
                                    "; each disturbs the other, and nothing here says which is the "
                                    "faster: cut it, or let one workspace decide");
      }
  }

  Planning& planning_;
  std::set<std::string> actors_;
  Ways links_, focus_;
  std::set<std::pair<std::string, std::string>> warned_;
};

}  // namespace

void check_motion(Planning& planning) {
  MotionCheck check(planning);
  check.warn_of_loops();
  check.warn_of_holds();
}

}  // namespace hc::internal
