// SPDX-License-Identifier: Apache-2.0
// How a graph that runs is changed: by its files, and by commands.
#include <hc/graph/commands.h>
#include <hc/graph/run/runner.h>

#include <algorithm>

namespace hc::internal {

void Runner::read_anew() {
  if (is_stopping_) return;
  auto planned = options_.replan(Reading::Anew, commands_, plan_);
  if (!planned.plan && !commands_.empty()) {
    // Perhaps the file is right, and what was asked beside it does not go with it any more.
    auto alone = options_.replan(Reading::Anew, {}, plan_);
    if (alone.plan) {
      for (const auto& line : planned.problems) say("graph: " + line);
      say("graph: the commands so far are forgotten");
      commands_.clear();
      planned = std::move(alone);
    }
  }
  files_->set_files(planned.files.empty() ? options_.files : planned.files);
  if (planned.plan) return change_to(std::move(*planned.plan));
  for (const auto& line : planned.problems) say("graph: " + line);
  say("graph: goes on as it was");
}

/// Does what all of some commands say, or nothing; gives what is wrong.
std::vector<std::string> Runner::obey(const std::vector<std::string>& lines) {
  std::vector<std::string> wrong;
  std::vector<Command> commands;
  auto edits = commands_;
  for (const auto& line : lines) {
    auto command = parse_command(line);
    if (!command) {
      wrong.push_back(command.error().detail);
      continue;
    }
    if (command->is_edit()) add_command(edits, line);
    if (command->verb == Command::Verb::Restart && find(command->words[0]) == nullptr)
      wrong.push_back("no module \"" + command->words[0] + "\"");
    commands.push_back(std::move(*command));
  }
  if (is_stopping_) wrong.emplace_back("the graph is stopping");
  if (!wrong.empty()) return wrong;
  if (edits != commands_) {
    if (!options_.replan) return {"this graph cannot be changed"};
    auto planned = options_.replan(Reading::AsBefore, edits, plan_);
    if (!planned.plan) return planned.problems;
    commands_ = std::move(edits);
    change_to(std::move(*planned.plan));
  }
  for (const auto& command : commands) {
    if (command.verb == Command::Verb::Restart) {
      if (auto* module = find(command.words[0])) module->restart();
    } else if (command.verb == Command::Verb::Stop) {
      is_stopped_ = true;
      end_all();
    }
  }
  return {};
}

/// Reads links that the next plan has no more until their writers have been told so: one that waits
/// for a reader that has left hears no commands.
void Runner::read_what_ends(const Plan& next) {
  auto is_there = [&](const PlannedLink& link) {
    return std::any_of(next.links.begin(), next.links.end(), [&](const PlannedLink& other) {
      return other.from == link.from && other.to == link.to && other.sender_uri == link.sender_uri;
    });
  };
  for (const auto& link : plan_.links) {
    const Supervised* writer = at(link.from);
    if (writer == nullptr || writer->is_over() || at(link.to) == nullptr || is_there(link))
      continue;
    if (auto stand_in = make_stand_in(*loop_, link.reader_uri, StandIn::UntilTheLinkEnds))
      ending_.push_back(std::move(*stand_in));
  }
}

/// Makes the graph that runs as another plan says.
void Runner::change_to(Plan plan) {
  read_what_ends(plan);
  plan_ = std::move(plan);
  is_unsettled_ = true;
  bool has_changed = false;
  std::map<std::string, const PlannedModule*> planned;
  for (const auto& module : plan_.modules) planned[module.name] = &module;
  for (auto& [name, module] : modules_)
    if (auto found = planned.find(name); found != planned.end())
      module->change_plan(*found->second);
  for (auto entry = modules_.begin(); entry != modules_.end();) {
    auto module = entry++;
    if (planned.contains(module->first)) continue;
    has_changed = true;
    module->second->end();
    leaving_.insert(modules_.extract(module));
  }
  for (const auto& module : plan_.modules) {
    auto* there = find(module.name);
    has_changed = there == nullptr || there->start_change() || has_changed;
    if (there == nullptr) add(module);
  }
  for (auto& [name, module] : modules_) module->end_change();
  say(has_changed ? "graph: changed" : "graph: as it was");
}

void Runner::add(const PlannedModule& module) {
  if (auto back = leaving_.extract(module.name)) {
    auto& there = *modules_.insert(std::move(back)).position->second;
    there.change_plan(module);
    return there.restart();
  }
  auto made = make(module);
  if (!made) return say(module.name + ": " + made.error().text());
  auto& added = *(modules_[module.name] = std::move(*made));
  added.restart();
}

}  // namespace hc::internal
