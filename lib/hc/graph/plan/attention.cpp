// SPDX-License-Identifier: Apache-2.0
// System modes: which there are, who works in them, and who is told which one is in focus.
#include <hc/graph/plan/planning.h>

namespace hc::internal {
namespace {

constexpr const char* kFocus = "focus";  // a workspace's output, and everybody's input

class Attention {
 public:
  explicit Attention(Planning& planning)
      : planning_(planning), graph_(planning.graph), problems_(planning.problems) {}

  void run() {
    take_modes();
    const bool workspace = check_workspace();
    for (const auto& link : graph_.links)
      if (link.to.port == kFocus) linked_.insert(link.to.text());
    for (const auto& module : graph_.modules)
      if (PlannedModule* planned = planning_.planned(module.name)) {
        if (planning_.description_of(module.name)->control) tell(module, *planned);
        if (workspace && module.name != graph_.workspace->value && wants_focus(module))
          link_focus(module);
      }
  }

 private:
  void take_modes() {
    std::map<std::int64_t, std::string> names;
    std::set<std::string> bidden;
    for (const auto& module : graph_.modules)
      if (module.mode) bidden.insert(module.mode->value);
    for (const auto& mode : graph_.modes) {
      names_.push_back(mode.name);
      auto [other, is_new] = names.emplace(mode.number, mode.name);
      if (!is_new)
        problems_.add(mode.place,
                      "the modes " + other->second + " and " + mode.name + " have the same number");
      if (!planning_.plan.modes.emplace(mode.name, mode.number).second)
        problems_.add(mode.place, "mode " + mode.name + " has two numbers");
      else if (!bidden.contains(mode.name))
        problems_.add(mode.place, "nobody can begin or leave mode " + mode.name +
                                      ": no module has mode = \"" + mode.name + "\"");
    }
  }

  /// Whether there is a workspace that tells the focus.
  bool check_workspace() {
    if (!graph_.workspace || graph_.workspace->value.empty()) return false;
    const auto& [name, place] = *graph_.workspace;
    planning_.plan.workspace = name;
    if (!planning_.names.contains(name)) {
      add_no_module(planning_, place, name);
      return false;
    }
    const Description* description = planning_.description_of(name);
    if (description == nullptr) return false;
    const DescribedPort* output = find_output(*description, kFocus);
    if (output == nullptr) {
      add_no_port(planning_, place, {name, kFocus, {}}, "output", description->outputs);
    } else if (!fits(*output, focus_input())) {
      problems_.add(place, name + ".focus gives " + in_words(output->types) + ", not " +
                               in_words(focus_input().types));
      return false;
    }
    return output != nullptr;
  }

  static bool wants_focus(const GraphModule& module) {
    return !module.modes.empty() || module.idle_rate || !module.exclusive.empty();
  }

  void link_focus(const GraphModule& module) {
    GraphLink link;
    link.from = {graph_.workspace->value, kFocus, {}};
    link.to = {module.name, kFocus, {}};
    link.policy["keep"] = {"latest", {}};  // who is slow must not keep the others from hearing
    link.place = module.place;
    bool is_there = std::any_of(graph_.links.begin(), graph_.links.end(),
                                [&](const auto& each) { return each.to.text() == link.to.text(); });
    if (!is_there) planning_.graph.links.push_back(std::move(link));
  }

  std::optional<std::int64_t> number_of(const Lined<std::string>& mode) {
    auto found = planning_.plan.modes.find(mode.value);
    if (found != planning_.plan.modes.end()) return found->second;
    problems_.add(mode.place,
                  "no mode \"" + mode.value + "\"" + suggest(planning_, mode.value, names_));
    return std::nullopt;
  }

  /// Puts what a module says of its modes into its command.
  void tell(const GraphModule& module, PlannedModule& planned) {
    auto add = [&](const char* option, std::string value) {
      planned.options.insert(planned.options.end(), {option, std::move(value)});
    };
    if (module.mode) {
      planned.mode = module.mode->value;
      if (auto number = number_of(*module.mode)) add("--mode", std::to_string(*number));
    }
    std::string numbers;
    for (const auto& mode : module.modes) {
      planned.modes.push_back(mode.value);
      if (auto number = number_of(mode))
        numbers += (numbers.empty() ? "" : ",") + std::to_string(*number);
    }
    if (!numbers.empty()) add("--modes", numbers);
    if (module.idle_rate) add("--idle-rate", module.idle_rate->value);
    const Description& description = *planning_.description_of(module.name);
    for (const auto& input : module.exclusive) {
      if (find_named(description.inputs, input.value) == nullptr)
        add_no_port(planning_, input.place, {module.name, input.value, {}}, "input",
                    description.inputs);
      else if (!planned.exclusive.insert(input.value).second)
        continue;
      else if (!graph_.workspace)
        problems_.add(input.place,
                      "an exclusive input wants a [workspace], which says what is in focus");
      add("--exclusive", input.value);
    }
  }

  Planning& planning_;
  const Graph& graph_;
  Problems& problems_;
  std::vector<std::string> names_;
  std::set<std::string> linked_;  // inputs `focus` to which the file has a link
};

}  // namespace

void plan_modes(Planning& planning) {
  Attention(planning).run();
}

}  // namespace hc::internal
