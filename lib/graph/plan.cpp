// SPDX-License-Identifier: Apache-2.0
#include <graph/plan.h>

#include <algorithm>

#include <graph/plan/planning.h>
#include <hc/base/suggestion.h>

namespace hc {
namespace internal {
namespace {

constexpr std::size_t kMostSuggestions = 100;  // each is compared with all names that are known

/// A type's elements, were they encoded so.
Info info_with(const PortType& type, Encoding encoding) {
  Info info = type.info;
  info.encoding = encoding;
  return info;
}

/// Plans a module, but for what others have a part in: addresses, modes, links.
class ModulePlanner {
 public:
  ModulePlanner(Planning& planning, const GraphModule& module)
      : planning_(planning), problems_(planning.problems), module_(module) {}

  void plan(const Description& description) {
    planned_.name = module_.name;
    planned_.program = module_.program.value;
    planned_.host = module_.host.value;
    planned_.group = module_.group;
    planned_.options = {"--name", module_.name};
    planned_.restart = module_.restart;
    planned_.hang = std::chrono::seconds(module_.hang.value);
    planned_.ends_graph = module_.ends_graph;
    planned_.manage_uri = "unix-listen:@" + planning_.plan.token + "." + module_.name + ".manage";
    if (description.control && !description.knows("unix"))
      problems_.add(module_.place,
                    "module {} supports --control, which takes unix: URIs, but its program does "
                    "not list unix in \"transports\"",
                    module_.name);
    if (description.control)
      planned_.control_uri = "unix-listen:@" + planning_.plan.token + "." + module_.name +
                             ".control?readers=0&keep=64";
    else
      check_needs_no_control(description);
    planned_.description = to_json(description);
    add_parameters(description);
    add_encodings();
    planning_.index[module_.name] = planning_.plan.modules.size();
    planning_.plan.modules.push_back(std::move(planned_));
  }

 private:
  void add_parameters(const Description& description) {
    for (const auto& parameter : description.parameters)
      planned_.known.emplace(parameter.name, parameter);
    for (const auto& [name, value] : module_.parameters) {
      if (auto checked = planned_.check_parameter(name, value.value); !checked)
        problems_.add(value.place, checked.error().detail);
      planned_.parameters[name] = value.value;
    }
  }

  void add_encodings() {
    for (const auto& [port, encoding] : module_.encodings) {
      const auto* output = find_port(planning_, encoding.place, {module_.name, port, {}}, false);
      if (output != nullptr && !output->types.empty())
        if (auto broken = find_error(info_with(output->types.front(), encoding.value)))
          problems_.add(encoding.place, "module {}: R{} {}: {}", module_.name, broken->rule, port,
                        broken->what);
      planned_.add_option("--encoding", port + "=" + std::string(name(encoding.value)));
    }
  }

  /// What a program that does not say "control" would ignore.
  void check_needs_no_control(const Description& description) {
    auto refuse = [&](const Place& place, const std::string& key) {
      problems_.add(place, kNeedsControl, module_.name, key);
    };
    for (const auto& [port, to] : module_.to) refuse(to.place, "to");
    if (module_.mode) refuse(module_.mode->place, "mode");
    if (!module_.modes.empty()) refuse(module_.modes.front().place, "modes");
    if (!module_.exclusive.empty()) refuse(module_.exclusive.front().place, "exclusive");
    if (description.routes)
      problems_.add(module_.place,
                    "module {} is a router, but its program does not support --control",
                    module_.name);
  }

  Planning& planning_;
  Problems& problems_;
  const GraphModule& module_;
  PlannedModule planned_;
};

void plan_module(Planning& planning, const Describe& describe, const GraphModule& module) {
  planning.names.insert(module.name);
  const std::string& program = module.program.value;
  if (program.empty()) return;
  auto text = describe(program, module.host.value);
  if (!text)
    return planning.problems.add(module.place, "module {}: {}", module.name, text.error().detail);
  auto description = parse_description(*text);
  if (!description)
    return planning.problems.add(module.place,
                                 "module {}: {} --describe does not print the description of a "
                                 "module; see spec/module.md",
                                 module.name, program);
  if (auto named = check_names(*description); !named)
    return planning.problems.add(module.place, "module {}: {}", module.name, named.error().detail);
  if (planning.index.contains(module.name)) return;  // a duplicate, which has been reported
  ModulePlanner(planning, module).plan(planning.described[module.name] = std::move(*description));
}

}  // namespace

bool has_text_parameter(const Description& description, std::string_view name) {
  const auto* parameter = find_named(description.parameters, name);
  return parameter != nullptr && std::holds_alternative<std::string>(parameter->value);
}

std::string suggest(const Planning& planning, std::string_view name,
                    const std::vector<std::string>& known) {
  return planning.problems.size() > kMostSuggestions ? "" : suggestion(name, known);
}

void add_no_port(Planning& planning, const Place& place, const GraphPort& port,
                 const std::string& kind, const std::vector<PortDescription>& ports) {
  planning.problems.add(place, "module {} has no {} \"{}\"{}", port.module, kind, port.port,
                        suggest(planning, port.port, names_of(ports)));
}

const PortDescription* find_port(Planning& planning, const Place& place, const GraphPort& port,
                                 bool is_input) {
  const std::string& module = port.module;
  if (!planning.names.contains(module)) {
    const std::string hint =
        port.port == "mtp"
            ? "; a file is \"file:" + port.text() + "\""
            : suggest(planning, module, {planning.names.begin(), planning.names.end()});
    planning.problems.add(place, "no module \"" + module + "\"" + hint);
  }
  const Description* description = planning.description_of(module);
  if (description == nullptr) return nullptr;
  const auto& ports = is_input ? description->inputs : description->outputs;
  const auto* found =
      is_input ? find_input(*description, port.port) : find_output(*description, port.port);
  if (found == nullptr) add_no_port(planning, place, port, is_input ? "input" : "output", ports);
  return found;
}

}  // namespace internal

Status PlannedModule::check_parameter(const std::string& parameter,
                                      const std::string& value) const {
  auto found = known.find(parameter);
  if (found == known.end()) {
    std::vector<std::string> names;
    for (const auto& [each, state] : known) names.push_back(each);
    return Error{Code::Invalid, hc::format("module {} has no parameter \"{}\"{}", name, parameter,
                                           suggestion(parameter, names))};
  }
  ParameterState state = found->second;
  if (auto set = state.set(value); !set)
    return Error{Code::Invalid, "module " + name + ": " + set.error().detail};
  return {};
}

std::vector<std::string> PlannedModule::command() const {
  std::vector<std::string> words = {program};
  words.insert(words.end(), options.begin(), options.end());
  for (const auto& [key, value] : parameters) words.push_back("--" + key + "=" + value);
  auto add = [&](const char* option, std::string value) {
    words.emplace_back(option);
    words.push_back(std::move(value));
  };
  auto peer_of = [](std::string_view listening) {
    listening = listening.substr(0, listening.find('?'));
    return "unix" + std::string(listening.substr(listening.find(':'))) + "?wait=10";
  };
  if (!manage_uri.empty()) add("--manage", peer_of(manage_uri));
  if (!control_uri.empty()) add("--control", peer_of(control_uri));
  for (const auto& end : ends) add(end.is_input ? "--in" : "--out", end.port + "=" + end.uri);
  for (const auto& end : ends)
    if (!end.route.empty()) add("--route", end.port + "=" + end.uri + " " + end.route);
  return words;
}

std::set<std::string> reach(const Ways& ways, std::set<std::string> modules) {
  std::vector<std::string> next(modules.begin(), modules.end());
  while (!next.empty()) {
    const auto found = ways.find(next.back());
    next.pop_back();
    if (found == ways.end()) continue;
    for (const auto& module : found->second)
      if (modules.insert(module).second) next.push_back(module);
  }
  return modules;
}

Plan make_plan(Graph graph, const Describe& describe, std::string_view token, Problems& problems,
               const Plan* before, const HoldPort& hold_port, const HostPlaces& places) {
  if (!graph.is_whole) return {};
  internal::Planning planning{std::move(graph), problems, before, hold_port, places};
  planning.plan.token = token;
  for (const auto& module : planning.graph.modules)
    internal::plan_module(planning, describe, module);
  internal::number_ports(planning);
  internal::plan_modes(planning);
  internal::link_frames(planning);
  internal::check_links(planning);
  internal::check_loops(planning);
  internal::check_actors(planning);
  internal::check_together(planning);
  internal::check_bids(planning);
  internal::check_destinations(planning);
  internal::plan_frames(planning);
  if (!problems.empty()) return std::move(planning.plan);
  internal::plan_links(planning);
  internal::check_motion(planning);
  planning.plan.warnings = problems.warnings();
  for (const auto& module : planning.graph.modules)
    for (const auto& output : planning.described.at(module.name).outputs)
      if (const GraphPort port{module.name, output.name, {}}; !planning.is_read(port))
        planning.plan.unlinked.push_back(port.text());
  return std::move(planning.plan);
}

}  // namespace hc
