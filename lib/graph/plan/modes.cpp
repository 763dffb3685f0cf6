// SPDX-License-Identifier: Apache-2.0
// System modes: their numbers, the modules that work in them, and the links of the focus.
#include <graph/plan/planning.h>
#include <hc/contract/mode_names.h>

namespace hc::internal {
namespace {

constexpr const char* kFocus = "focus";  // output of a workspace, input of any module

class Modes {
 public:
  explicit Modes(Planning& planning)
      : planning_(planning), graph_(planning.graph), problems_(planning.problems) {}

  void run() {
    take_modes();
    for (const auto& workspace : graph_.workspaces)
      if (publishes_focus(workspace)) planning_.plan.workspaces.insert(workspace.value);
    for (const auto& module : graph_.modules)
      if (PlannedModule* planned = planning_.planned(module.name)) {
        name_modes(*planning_.description_of(module.name), *planned);
        name_sources(*planning_.description_of(module.name), *planned);
        if (planning_.description_of(module.name)->control) add_options(module, *planned);
        if (!planning_.plan.workspaces.contains(module.workspace)) continue;
        planned->workspace = module.workspace;
        if (module.name != module.workspace && wants_focus(module)) link_focus(module);
      }
  }

 private:
  void take_modes() {
    std::map<std::int64_t, std::string> names;
    std::set<std::string> tasks;
    for (const auto& module : graph_.modules)
      if (module.mode) tasks.insert(module.mode->value);
    for (const auto& mode : graph_.modes) {
      names_.push_back(mode.name);
      auto [other, is_new] = names.emplace(mode.number, mode.name);
      if (!is_new)
        problems_.add(mode.place, "modes {} and {} have the same number", other->second, mode.name);
      if (!planning_.plan.modes.emplace(mode.name, mode.number).second)
        problems_.add(mode.place, "mode " + mode.name + " has two numbers");
      else if (!tasks.contains(mode.name))
        problems_.add(mode.place, "mode {} has no task: no module has mode = \"{}\"", mode.name,
                      mode.name);
    }
  }

  bool publishes_focus(const Lined<std::string>& workspace) {
    const auto& [name, place] = workspace;
    if (name.empty()) return false;
    const PortDescription* output = find_port(planning_, place, {name, kFocus, {}}, false);
    if (output == nullptr) return false;
    const bool is_right = fits(output->types, focus_input().types);
    if (!is_right)
      problems_.add(place, "{}.focus sends {}, not {}", name, in_words(output->types),
                    in_words(focus_input().types));
    return is_right;
  }

  /// Sets the parameter `mode_names` of a module that has one.
  void name_modes(const Description& description, PlannedModule& planned) {
    if (planning_.plan.modes.empty() || !has_text_parameter(description, kModeNames)) return;
    planned.parameters.try_emplace(kModeNames, mode_names_text(planning_.plan.modes));
  }

  /// Sets the parameter `source_names` of a module that has one.
  void name_sources(const Description& description, PlannedModule& planned) {
    if (!has_text_parameter(description, kSourceNames)) return;
    std::map<std::string, std::int64_t> names;
    for (const auto& link : graph_.links) {
      const auto source = planning_.plan.sources.find(link.from.module + "." + link.from.port);
      if (link.to.module == planned.name && source != planning_.plan.sources.end())
        names.insert(*source);
    }
    if (!names.empty()) planned.parameters.try_emplace(kSourceNames, mode_names_text(names));
  }

  static bool wants_focus(const GraphModule& module) {
    return !module.modes.empty() || !module.exclusive.empty();
  }

  void link_focus(const GraphModule& module) {
    GraphLink link;
    link.from = {module.workspace, kFocus, {}};
    link.to = {module.name, kFocus, {}};
    link.policy["keep"] = {"latest", {}};  // a slow reader must not block the others
    link.place = module.place;
    if (!planning_.is_linked(link.to)) planning_.graph.links.push_back(std::move(link));
  }

  std::optional<std::int64_t> number_of(const Lined<std::string>& mode) {
    auto found = planning_.plan.modes.find(mode.value);
    if (found != planning_.plan.modes.end()) return found->second;
    problems_.add(mode.place, "no mode \"{}\"{}", mode.value,
                  suggest(planning_, mode.value, names_));
    return std::nullopt;
  }

  /// Adds the options --mode, --modes and --exclusive.
  void add_options(const GraphModule& module, PlannedModule& planned) {
    if (module.mode) {
      planned.mode = module.mode->value;
      if (auto number = number_of(*module.mode))
        planned.add_option("--mode", std::to_string(*number));
    }
    std::vector<std::string> numbers;
    for (const auto& mode : module.modes) {
      planned.modes.push_back(mode.value);
      if (auto number = number_of(mode)) numbers.push_back(std::to_string(*number));
    }
    if (!numbers.empty()) planned.add_option("--modes", joined(numbers, ","));
    const Description& description = *planning_.description_of(module.name);
    for (const auto& input : module.exclusive) {
      if (find_named(description.inputs, input.value) == nullptr)
        add_no_port(planning_, input.place, {module.name, input.value, {}}, "input",
                    description.inputs);
      else if (!planned.exclusive.insert(input.value).second)
        continue;
      else if (module.workspace.empty())
        check_unlinked(module, input);
      else
        planned.add_option("--exclusive", input.value);
    }
  }

  /// An exclusive input without a workspace cannot be linked, now or by a command later.
  void check_unlinked(const GraphModule& module, const Lined<std::string>& input) {
    if (!has_wrong_workspace() && planning_.is_linked({module.name, input.value, {}}))
      problems_.add(input.place,
                    "exclusive inputs require a [workspace] table: add it with module = "
                    "\"workspace\", and [modules.workspace]; or set exclusive = []");
  }

  [[nodiscard]] bool has_wrong_workspace() const {
    return std::any_of(graph_.workspaces.begin(), graph_.workspaces.end(),
                       [](const auto& workspace) { return workspace.value.empty(); });
  }

  Planning& planning_;
  const Graph& graph_;
  Problems& problems_;
  std::vector<std::string> names_;
};

}  // namespace

void plan_modes(Planning& planning) {
  Modes(planning).run();
}

namespace {

/// Warns of modules that decide on the focus, while the file says of none that it does.
void warn_of_undeclared(Planning& planning) {
  for (const auto& module : planning.graph.modules)
    if (const auto* described = planning.description_of(module.name);
        described != nullptr && find_named(described->inputs, "bids") != nullptr &&
        find_named(described->outputs, kFocus) != nullptr)
      planning.problems.warn(module.place, "module " + module.name +
                                               " takes bids, but no task gets the focus from it: "
                                               "add [workspace] with module = \"" +
                                               module.name + "\"");
}

}  // namespace

/// A mode gets the focus only if its task's bids reach a workspace, possibly through routers. Not
/// checked for a running graph, whose links may be added later.
void check_bids(Planning& planning) {
  const Graph& graph = planning.graph;
  if (planning.before != nullptr || !planning.problems.empty()) return;
  if (planning.plan.workspaces.empty()) return warn_of_undeclared(planning);
  Edges back;  // the name outside the graph is empty
  for (const auto& link : graph.links)
    if (planning.plan.workspaces.contains(link.to.module) || planning.is_router(link.to.module))
      back[link.to.module].insert(link.from.module);
  for (const auto& link : graph.links) {
    const auto* from = find_named(graph.modules, link.from.module);
    if (from == nullptr || from->mode || link.to.port != "bids") continue;
    if (planning.plan.workspaces.contains(link.to.module) && !planning.is_router(from->name))
      planning.problems.warn(link.place,
                             "module " + from->name +
                                 " bids without a mode, which is refused: add mode = \"NAME\", "
                                 "unless its messages have one");
  }
  const auto bidding = reach(back, planning.plan.workspaces);  // workspaces and senders to them
  if (bidding.contains("")) return;                            // bids from outside are not known
  for (const auto& mode : graph.modes) {
    auto bids = [&](const GraphModule& module) {
      return module.mode && module.mode->value == mode.name && bidding.contains(module.name);
    };
    if (std::none_of(graph.modules.begin(), graph.modules.end(), bids))
      planning.problems.add(mode.place,
                            "mode {} never gets the focus: no module with mode = \"{}\" sends bids "
                            "to a workspace",
                            mode.name, mode.name);
  }
}

}  // namespace hc::internal
