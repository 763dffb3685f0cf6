// SPDX-License-Identifier: Apache-2.0
// Which inputs programs outside a running graph may send to.
#include <algorithm>
#include <deque>

#include <graph/plan.h>
#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>

namespace hc {
namespace {

std::string module_of(const std::string& port) {
  return port.substr(0, port.find('.'));
}
std::string port_of(const std::string& port) {
  return port.substr(port.find('.') + 1);
}

bool is_actor(const PlannedModule& module, const std::string& port) {
  const auto description = parse_description(module.description);
  const auto* input = description ? find_named(description->inputs, port) : nullptr;
  return input != nullptr && input->actor;
}

/// The actor's input to which a module's messages lead without passing a task; empty: none.
std::string actor_behind(const Plan& plan, const PlannedModule& first) {
  std::set<std::string> seen = {first.name};
  std::deque<const PlannedModule*> next = {&first};
  for (; !next.empty(); next.pop_front()) {
    // What a task sends carries its mode, and competes for the focus.
    if (!next.front()->mode.empty()) continue;
    for (const auto& link : plan.links) {
      if (module_of(link.from) != next.front()->name) continue;
      const auto* reader = find_named(plan.modules, module_of(link.to));
      if (reader == nullptr) continue;
      if (is_actor(*reader, port_of(link.to))) return link.to;
      if (seen.insert(reader->name).second) next.push_back(reader);
    }
  }
  return "";
}

}  // namespace

Status check_feed(const Plan& plan, const std::string& input) {
  const auto name = module_of(input), port = port_of(input);
  const auto* module = find_named(plan.modules, name);
  const auto description = parse_description(module == nullptr ? "" : module->description);
  if (!description || find_input(*description, port) == nullptr) {
    std::vector<std::string> known;
    for (const auto& each : plan.modules)
      if (const auto other = parse_description(each.description))
        for (const auto& its : other->inputs) known.push_back(each.name + "." + its.name);
    return Error{Code::Invalid, hc::format("no input \"{}\"{}", input, suggestion(input, known))};
  }
  auto refuse = [&](const std::string& why) { return Error{Code::Invalid, input + " " + why}; };
  if (!description->knows("unix-listen"))
    return refuse("cannot be sent to: its program does not support unix-listen");
  // A stop moves nothing, and neither does clearing it: the mode that gets the focus does.
  const bool is_workspace = plan.workspaces.contains(name);
  const bool is_focus = find_input(*description, port) == &focus_input();
  if (is_focus || (is_workspace && port != "stop"))
    return refuse("decides on the focus: only the links of the graph lead there");
  if (is_actor(*module, port) || module->exclusive.contains(port))
    return refuse("obeys the task in focus only: send to an input of a task");
  if (const auto actor = actor_behind(plan, *module); !actor.empty())
    return refuse(hc::format(
        "leads to {}, which obeys the task in focus only, and not through a task", actor));
  return {};
}

}  // namespace hc
