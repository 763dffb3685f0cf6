// SPDX-License-Identifier: Apache-2.0
// Changes of a running graph, by its files and by commands.
#include <graph/run/runner.h>
#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/trace.h>

#include <algorithm>

namespace hc::internal {
namespace {

constexpr const char* kIsStopping = "the graph is stopping";

constexpr std::size_t kMostChanges = 100;  // queued while a slow program describes itself

using Commands = std::vector<GraphCommand>;

bool has_edits(const Commands& commands) {
  return std::any_of(commands.begin(), commands.end(),
                     [](const GraphCommand& command) { return command.is_edit(); });
}

/// Whether the edits among the commands only set parameters.
bool only_set(const Commands& commands) {
  return std::all_of(commands.begin(), commands.end(), [](const GraphCommand& command) {
    return !command.is_edit() || command.verb == GraphCommand::Verb::Set;
  });
}

}  // namespace

/// Reloads the graph after a change of its files.
void Runner::reload() {
  if (is_stopping_) return;
  const auto& file = graph_.files.front();
  const bool is_gone = !files_->was_there(file);
  if (is_gone && !is_file_gone_)
    log(file + " has been removed; keeping the running version", Level::Warning);
  is_file_gone_ = is_gone;
  if (is_gone) return;
  auto is_reload = [](const Change& change) { return change.commands.empty(); };
  // A queued reload will read the newest files; one in progress is out of date.
  if (!changes_.empty() && std::any_of(changes_.begin() + 1, changes_.end(), is_reload)) return;
  if (!changes_.empty() && is_reload(changes_.front())) planning_.stop();
  changes_.push_back({});
  begin_changes();
}

/// Executes all commands, or none.
void Runner::obey(const std::vector<std::string>& lines, const GraphServer::Reply& reply) {
  std::vector<std::string> wrong;
  Commands commands;
  for (const auto& line : lines) {
    auto command = parse_graph_command(line);
    if (!command)
      wrong.push_back(command.error().detail);
    else if (command->is_question() && lines.size() > 1)
      wrong.push_back(line + ": send it alone in a message");
    else if (command->is_question())
      return reply(answer_to(*command));
    else if (command->verb == GraphCommand::Verb::Restart && find(command->words[0]) == nullptr)
      wrong.push_back("no module \"" + command->words[0] + "\"");
    else
      commands.push_back(std::move(*command));
  }
  if (lines.empty()) wrong.emplace_back("there is no command");
  if (is_stopping_) wrong.emplace_back(kIsStopping);
  if (changes_.size() >= kMostChanges) wrong.emplace_back("too many queued changes; try again");
  if (!wrong.empty()) return reply({false, wrong});
  if (!has_edits(commands)) {
    carry_out(commands);
    return reply({true, {}});
  }
  changes_.push_back({std::move(commands), reply});
  begin_changes();
}

GraphAnswer Runner::answer_to(const GraphCommand& question) {
  const auto& word = question.words[0];
  const auto found = question.verb == GraphCommand::Verb::Observe ? observe(word) : describe(word);
  return found ? GraphAnswer{true, {*found}} : GraphAnswer{false, {found.error().detail}};
}

/// Opens an output to observers. For an input, opens the output linked to it.
Result<std::string> Runner::observe(const std::string& port) {
  std::vector<std::string> known, writers;
  for (const auto& [output, address] : plan_.sources) known.push_back(output);
  for (const auto& link : plan_.links) {
    if (at(link.to) != nullptr) known.push_back(link.to);
    // An input may have an output's name: that output is meant.
    if (link.to == port && !plan_.sources.contains(port)) writers.push_back(link.from);
  }
  if (writers.size() > 1)
    return Error{Code::Invalid,
                 port + " has several writers; observe one of them: " + joined(writers, ", ")};
  const std::string& output = writers.empty() ? port : writers.front();
  const bool is_output =
      plan_.sources.contains(output) || output.ends_with("." + std::string(kTracePort));
  Supervised* module = is_output ? at(output) : nullptr;
  if (module == nullptr && !writers.empty())
    return Error{Code::Invalid, port + " is fed by " + output + ", which is outside the graph"};
  if (module == nullptr)
    return Error{Code::Invalid, "no port \"" + port + "\"" + suggestion(port, known)};
  if (module->plan().control_uri.empty())
    return Error{Code::Invalid,
                 module->plan().name + " cannot be observed: its program takes no commands"};
  const int number =
      observed_.try_emplace(output, static_cast<int>(observed_.size())).first->second;
  return module->observe(output.substr(output.find('.') + 1),
                         plan_.token + ".watch." + std::to_string(number));
}

Result<std::string> Runner::describe(const std::string& module) const {
  std::vector<std::string> known;
  for (const auto& each : plan_.modules) {
    if (each.name == module) return each.description;
    known.push_back(each.name);
  }
  return Error{Code::Invalid, "no module \"" + module + "\"" + suggestion(module, known)};
}

/// Executes the commands that do not change the plan.
void Runner::carry_out(const Commands& commands) {
  for (const auto& command : commands) {
    if (command.verb == GraphCommand::Verb::Restart) {
      if (auto* module = find(command.words[0])) module->restart();
    } else if (command.verb == GraphCommand::Verb::Stop) {
      is_stopped_ = true;
      end_all();
    }
  }
}

/// Makes queued changes up to the first that needs planning, which happens on another thread, as a
/// new program may be slow to describe itself.
void Runner::begin_changes() {
  while (!changes_.empty() && !is_stopping_ && !planning_.is_busy()) {
    const Commands& commands = changes_.front().commands;
    if (commands.empty())
      return begin_planning([this](int stop) { return options_.loader->load(&plan_, stop); });
    Graph graph = graph_;
    Problems problems(graph.files);
    for (const auto& command : commands) apply_command(graph, command, problems);
    GraphAnswer answer{problems.empty(), problems.lines()};
    if (answer.is_ok && only_set(commands))
      answer = set_parameters(commands);
    else if (answer.is_ok && options_.loader != nullptr)
      return begin_planning([this, graph = std::move(graph)](int stop) {
        return options_.loader->plan(graph, plan_, stop);
      });
    else if (answer.is_ok)
      answer = {false, {"this graph cannot be changed"}};
    if (answer.is_ok) graph_ = std::move(graph);
    end_change(answer);
  }
}

void Runner::begin_planning(std::function<Result<LoadedGraph>(int stop)> plan) {
  auto planning = run_aside(*loop_, std::move(plan),
                            [this](Result<LoadedGraph> loaded) { take_planned(loaded); });
  if (!planning) {
    end_change({false, {planning.error().text()}});
    return begin_changes();
  }
  planning_ = std::move(*planning);
}

void Runner::take_planned(Result<LoadedGraph>& loaded) {
  if (is_stopping_) return;
  const bool is_reload = changes_.front().commands.empty();
  std::vector<std::string> wrong;
  if (!loaded)
    wrong.push_back(loaded.error().detail);
  else if (!loaded->plan)
    wrong = loaded->problems;
  if (wrong.empty()) {
    graph_ = std::move(loaded->graph);
    change_to(std::move(*loaded->plan));
  } else if (is_reload && !planning_.is_stopped()) {  // otherwise a newer edit follows
    for (const auto& line : wrong) log(line, Level::Warning);
    log("keeping the running version", Level::Warning);
  }
  if (is_reload && loaded)
    files_->set_files(loaded->graph.files.empty() ? graph_.files : loaded->graph.files);
  end_change({wrong.empty(), wrong});
  begin_changes();
}

/// Completes the first change and answers it.
void Runner::end_change(const GraphAnswer& answer) {
  const Change change = std::move(changes_.front());
  changes_.pop_front();
  if (answer.is_ok) carry_out(change.commands);
  if (change.reply) change.reply(answer);
}

/// Refuses all queued changes.
void Runner::refuse_changes() {
  planning_.stop();
  for (const auto& change : std::exchange(changes_, {}))
    if (change.reply) change.reply({false, {kIsStopping}});
}

/// Sets all parameters, or none. The answer lists restarted modules.
GraphAnswer Runner::set_parameters(const Commands& commands) {
  std::vector<std::string> wrong, remarks;
  std::map<std::string, PlannedModule> changed;
  for (const auto& command : commands) {
    if (command.verb != GraphCommand::Verb::Set) continue;
    const auto &name = command.words[0], &parameter = command.words[1], &value = command.words[2];
    auto& module = changed.emplace(name, find(name)->plan()).first->second;
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
    auto* supervised = find(planned.name);
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
    if (auto* there = find(module.name))
      changes.emplace_back(there, there->adopt(module));
    else
      added.push_back(&module);
  }
  bool has_changed = !added.empty();
  for (auto& [module, change] : changes) {
    has_changed = has_changed || !change.is_empty();
    module->send_commands(change.unlinks);
  }
  for (auto entry = modules_.begin(); entry != modules_.end();) {
    auto module = entry++;
    if (names.contains(module->first)) continue;
    has_changed = true;
    module->second->end();
    leaving_.insert(modules_.extract(module));
  }
  for (auto& [module, change] : changes) module->send_commands(change.outputs);
  for (const auto* module : added) add(*module);
  for (auto& [module, change] : changes) module->send_commands(change.inputs);
  log(has_changed ? "changed" : "unchanged");
}

void Runner::add(const PlannedModule& module) {
  if (auto back = leaving_.extract(module.name)) {
    auto& there = *modules_.insert(std::move(back)).position->second;
    there.adopt(module);
    return there.restart();
  }
  auto made = make(module);
  if (!made) return log({module.name, Level::Warning, made.error().text()});
  auto& added = *(modules_[module.name] = std::move(*made));
  added.restart();
}

}  // namespace hc::internal
