// SPDX-License-Identifier: Apache-2.0
// What clients ask a running graph, and how it changes to another plan.
#include <graph/run/runner.h>

#include <map>

#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>
#include <hc/contract/trace.h>

namespace hc::internal {

GraphAnswer Runner::answer_to(const GraphCommand& question) {
  if (question.verb == GraphCommand::Verb::Notices) return {true, notices()};
  const auto& word = question.words[0];
  const auto found = question.verb == GraphCommand::Verb::Observe ? observe(word)
                     : question.verb == GraphCommand::Verb::Feed  ? feed(word)
                                                                  : describe(word);
  return found ? GraphAnswer{true, {*found}} : GraphAnswer{false, {found.error().detail}};
}

/// Opens an output to observers. For an input, opens the output linked to it.
Result<std::string> Runner::observe(const std::string& port) {
  std::vector<std::string> known, writers;
  for (const auto& [output, address] : plan_.sources) known.push_back(output);
  for (const auto& link : plan_.links) {
    if (modules_.at(link.to) != nullptr) known.push_back(link.to);
    // An input may have an output's name: that output is meant.
    if (link.to == port && !plan_.sources.contains(port)) writers.push_back(link.from);
  }
  if (writers.size() > 1)
    return Error{Code::Invalid,
                 port + " has several writers; observe one of them: " + joined(writers, ", ")};
  const std::string& output = writers.empty() ? port : writers.front();
  const bool is_output =
      plan_.sources.contains(output) || output.ends_with("." + std::string(kTracePort));
  Supervised* module = is_output ? modules_.at(output) : nullptr;
  if (module == nullptr && !writers.empty())
    return Error{Code::Invalid, port + " is fed by " + output + ", which is outside the graph"};
  if (module == nullptr)
    return Error{Code::Invalid, "no port \"" + port + "\"" + suggestion(port, known)};
  return open_port(false, output);
}

/// Opens an input to senders outside the graph.
Result<std::string> Runner::feed(const std::string& port) {
  HC_TRY(check_feed(plan_, port));
  return open_port(true, port);
}

/// @param port  of a module of the graph.
Result<std::string> Runner::open_port(bool is_input, const std::string& port) {
  Supervised* module = modules_.at(port);
  if (module == nullptr) return Error{Code::Invalid, port + ": its module does not run"};
  if (module->plan().control_uri.empty())
    return Error{Code::Invalid, module->plan().name + " cannot be " +
                                    (is_input ? "sent to" : "observed") +
                                    ": its program takes no commands"};
  const int number =
      opened_.try_emplace({is_input, port}, static_cast<int>(opened_.size())).first->second;
  return module->open_port(
      is_input, port.substr(port.find('.') + 1),
      plan_.token + (is_input ? ".feed." : ".watch.") + std::to_string(number));
}

Result<std::string> Runner::describe(const std::string& module) const {
  if (const auto* found = find_named(plan_.modules, module)) return found->description;
  return Error{Code::Invalid,
               "no module \"" + module + "\"" + suggestion(module, names_of(plan_.modules))};
}

/// The last notice of each module that the graph has.
std::vector<std::string> Runner::notices() const {
  std::map<std::string, std::string> last;
  for (const auto& notice : log_.notices())
    if (modules_.find(notice.module) != nullptr) last[notice.module] = notice.line();
  std::vector<std::string> lines;
  lines.reserve(last.size());
  for (const auto& [module, line] : last) lines.push_back(line);
  return lines;
}

/// Executes the commands that do not change the plan.
void Runner::carry_out(const Commands& commands) {
  for (const auto& command : commands) {
    if (command.verb == GraphCommand::Verb::Restart) {
      if (auto* module = modules_.find(command.words[0])) module->restart();
    } else if (command.verb == GraphCommand::Verb::Stop) {
      is_stopped_ = true;
      end_all();
    }
  }
}

/// Sets all parameters, or none. The answer lists restarted modules.
GraphAnswer Runner::set_parameters(const Commands& commands) {
  std::vector<std::string> wrong, remarks;
  std::map<std::string, PlannedModule> changed;
  for (const auto& command : commands) {
    if (command.verb != GraphCommand::Verb::Set) continue;
    const auto &name = command.words[0], &parameter = command.words[1], &value = command.words[2];
    auto& module = changed.emplace(name, modules_.find(name)->plan()).first->second;
    if (auto checked = module.check_parameter(parameter, value); !checked)
      wrong.push_back(checked.error().detail);
    module.parameters[parameter] = value;
    if (module.is_fixed(parameter))
      remarks.push_back("restarting " + name + ", since " +
                        (module.control_uri.empty() ? "it takes no commands"
                                                    : parameter + " is fixed while it runs"));
  }
  if (!wrong.empty()) return {false, wrong};
  for (auto& planned : plan_.modules) {
    auto module = changed.find(planned.name);
    if (module == changed.end()) continue;
    planned = module->second;
    auto* supervised = modules_.find(planned.name);
    supervised->send_commands(supervised->adopt(planned).outputs);
  }
  return {true, remarks};
}

/// Changes the running graph to another plan: removes links before adding any, and adds outputs
/// before inputs.
void Runner::change_to(Plan plan) {
  plan_ = std::move(plan);
  is_unsettled_ = true;
  std::vector<std::pair<Supervised*, ModuleChange>> changes;
  std::vector<const PlannedModule*> added;
  std::set<std::string> names;
  for (const auto& module : plan_.modules) {
    names.insert(module.name);
    if (auto* there = modules_.find(module.name))
      changes.emplace_back(there, there->adopt(module));
    else
      added.push_back(&module);
  }
  bool has_changed = !added.empty();
  for (auto& [module, change] : changes) {
    has_changed = has_changed || !change.is_empty();
    module->send_commands(change.unlinks);
  }
  std::vector<std::string> gone;
  for (const auto& [name, module] : modules_.all())
    if (!names.contains(name)) gone.push_back(name);
  for (const auto& name : gone) modules_.let_go(name);
  has_changed = has_changed || !gone.empty();
  for (auto& [module, change] : changes) module->send_commands(change.outputs);
  for (const auto* module : added) add(*module);
  for (auto& [module, change] : changes) module->send_commands(change.inputs);
  log_.add(has_changed ? "changed" : "unchanged");
}

void Runner::add(const PlannedModule& module) {
  if (auto* back = modules_.bring_back(module.name)) {
    back->adopt(module);
    return back->restart();
  }
  auto made = make(module);
  if (!made) return log_.add({module.name, Level::Warning, made.error().text()});
  modules_.insert(module.name, std::move(*made)).restart();
}

}  // namespace hc::internal
