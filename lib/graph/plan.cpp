// SPDX-License-Identifier: Apache-2.0
#include <graph/plan.h>

#include <graph/plan/planning.h>
#include <hc/base/suggestion.h>

namespace hc {
namespace internal {
namespace {

constexpr std::size_t kMostSuggestions = 100;  // each costs a comparison with all known names

/// A type's `info` with another encoding.
Info info_with(const PortType& type, Encoding encoding) {
  Info info = type.info;
  info.encoding = encoding;
  return info;
}

void add_parameters(Problems& problems, const GraphModule& module, const Description& description,
                    PlannedModule& planned) {
  for (const auto& parameter : description.parameters)
    planned.known.emplace(parameter.name, parameter);
  for (const auto& [name, value] : module.parameters) {
    if (auto checked = planned.check_parameter(name, value.value); !checked)
      problems.add(value.place, checked.error().detail);
    planned.parameters[name] = value.value;
  }
}

void add_encodings(Planning& planning, const GraphModule& module, PlannedModule& planned) {
  for (const auto& [port, encoding] : module.encodings) {
    const auto* output = find_port(planning, encoding.place, {module.name, port, {}}, false);
    if (output != nullptr && !output->types.empty())
      if (auto broken = find_error(info_with(output->types.front(), encoding.value)))
        planning.problems.add(encoding.place, "module {}: R{} {}: {}", module.name, broken->rule,
                              port, broken->what);
    planned.add_option("--encoding", port + "=" + std::string(name(encoding.value)));
  }
}

/// Refuses keys that a program without --control would ignore.
void check_needs_no_control(Problems& problems, const GraphModule& module,
                            const Description& description) {
  auto refuse = [&](const Place& place, const std::string& key) {
    problems.add(place, kNeedsControl, module.name, key);
  };
  for (const auto& [port, to] : module.to) refuse(to.place, "to");
  if (module.clock) refuse(module.clock->place, "clock");
  if (module.mode) refuse(module.mode->place, "mode");
  if (!module.modes.empty()) refuse(module.modes.front().place, "modes");
  if (!module.exclusive.empty()) refuse(module.exclusive.front().place, "exclusive");
  if (description.routes)
    problems.add(module.place, "module {} is a router, but its program does not support --control",
                 module.name);
}

/// Plans a module except for its addresses, modes and links, which depend on other modules.
void plan_module(Planning& planning, const Describe& describe, const GraphModule& module) {
  auto& problems = planning.problems;
  planning.names.insert(module.name);
  const std::string& program = module.program.value;
  if (program.empty()) return;
  auto text = describe(program, module.host.value);
  if (!text) return problems.add(module.place, "module {}: {}", module.name, text.error().detail);
  auto parsed = parse_description(*text);
  if (!parsed)
    return problems.add(module.place,
                        "module {}: {} --describe does not print the description of a module; see "
                        "spec/module.md",
                        module.name, program);
  if (auto named = check_names(*parsed); !named)
    return problems.add(module.place, "module {}: {}", module.name, named.error().detail);
  if (planning.index.contains(module.name)) return;  // a duplicate, already reported
  const auto& description = planning.described[module.name] = std::move(*parsed);
  const std::string name = "unix-listen:@" + planning.plan.token + "." + module.name;
  PlannedModule planned;
  planned.name = module.name;
  planned.program = program;
  planned.host = module.host.value;
  planned.group = module.group;
  planned.options = {"--name", module.name};
  if (module.clock) planned.add_option("--clock", module.clock->value);
  planned.restart = module.restart;
  planned.hang = std::chrono::seconds(module.hang.value);
  planned.ends_graph = module.ends_graph;
  planned.is_recorder = module.is_recorder;
  planned.manage_uri = name + ".manage";
  if (description.control && !description.knows("unix"))
    problems.add(module.place,
                 "module {} supports --control, which takes unix: URIs, but its program does not "
                 "list unix in \"transports\"",
                 module.name);
  if (description.control)
    planned.control_uri = name + ".control?readers=0&keep=64";
  else
    check_needs_no_control(problems, module, description);
  planned.description = to_json(description);
  add_parameters(problems, module, description, planned);
  add_encodings(planning, module, planned);
  planning.index[module.name] = planning.plan.modules.size();
  planning.plan.modules.push_back(std::move(planned));
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
  auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  auto peer_of = [](std::string_view listening) {
    listening = listening.substr(0, listening.find('?'));
    return "unix" + std::string(listening.substr(listening.find(':'))) + "?wait=10";
  };
  if (!manage_uri.empty()) add("--manage", peer_of(manage_uri));
  if (!control_uri.empty()) add("--control", peer_of(control_uri));
  for (const auto& end : ends) add(end.is_input ? "--in" : "--out", end.text());
  for (const auto& end : ends)
    if (!end.route.empty()) add("--route", end.text() + " " + end.route);
  return words;
}

std::set<std::string> reach(const Edges& edges, std::set<std::string> modules) {
  std::vector<std::string> next(modules.begin(), modules.end());
  while (!next.empty()) {
    const auto found = edges.find(next.back());
    next.pop_back();
    if (found == edges.end()) continue;
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
