// SPDX-License-Identifier: Apache-2.0
// How a graph that runs is changed: by its files, and by commands.
#include <hc/base/suggestion.h>
#include <hc/graph/commands.h>
#include <hc/graph/run/runner.h>

#include <algorithm>
#include <filesystem>

namespace hc::internal {
namespace {

namespace fs = std::filesystem;

constexpr const char* kIsStopping = "the graph is stopping";

}  // namespace

void Runner::read_anew() {
  if (is_stopping_) return;
  const auto& file = options_.files.front();
  std::error_code failed;
  const bool is_gone = fs::status(file, failed).type() == fs::file_type::not_found;
  if (is_gone && !is_file_gone_)
    say("graph: " + file + " has been removed; keeping the running version");
  is_file_gone_ = is_gone;
  if (is_gone) return;
  auto is_edit = [](const Change& change) { return change.commands.empty(); };
  // One that waits reads what is there then; what is being read is not what is there any more.
  if (!changes_.empty() && std::any_of(changes_.begin() + 1, changes_.end(), is_edit)) return;
  if (!changes_.empty() && is_edit(changes_.front())) planning_->stop();
  changes_.push_back({});
  plan_next();
}

/// Does what all of some commands say, or nothing.
void Runner::obey(const std::vector<std::string>& lines, Observation::Answer answer) {
  std::vector<std::string> wrong;
  bool has_edits = false;
  for (const auto& line : lines) {
    auto command = parse_command(line);
    if (!command) {
      wrong.push_back(command.error().detail);
      continue;
    }
    has_edits = has_edits || command->is_edit();
    if (command->verb == Command::Verb::Restart && find(command->words[0]) == nullptr)
      wrong.push_back("no module \"" + command->words[0] + "\"");
  }
  if (is_stopping_) wrong.emplace_back(kIsStopping);
  if (wrong.empty() && has_edits && !options_.replan)
    wrong.emplace_back("this graph cannot be changed");
  if (!wrong.empty()) return answer(wrong);
  if (!has_edits) {
    carry_out(lines);
    return answer({});
  }
  changes_.push_back({lines, std::move(answer)});
  plan_next();
}

/// Opens an output to observers; of an input, the output that it is linked to.
Result<std::string> Runner::observe(const std::string& port) {
  std::vector<std::string> known, writers;
  for (const auto& [output, address] : plan_.sources) known.push_back(output);
  for (const auto& link : plan_.links) {
    if (at(link.to) != nullptr) known.push_back(link.to);
    if (link.to == port) writers.push_back(link.from);
  }
  if (writers.size() > 1) {
    std::string list;
    for (const auto& writer : writers) list += (list.empty() ? "" : ", ") + writer;
    return Error{Code::Invalid, port + " has several writers; observe one of them: " + list};
  }
  const std::string& output = writers.empty() ? port : writers.front();
  Supervised* module = plan_.sources.contains(output) ? at(output) : nullptr;
  if (module == nullptr && !writers.empty())
    return Error{Code::Invalid,
                 port + " is fed by " + output + ", which no module of the graph is"};
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

/// Does what commands say that change nothing in the plan.
void Runner::carry_out(const std::vector<std::string>& lines) {
  for (const auto& line : lines) {
    const auto command = parse_command(line);
    if (command->verb == Command::Verb::Restart) {
      if (auto* module = find(command->words[0])) module->restart();
    } else if (command->verb == Command::Verb::Stop) {
      is_stopped_ = true;
      end_all();
    }
  }
}

/// Begins to plan the first change, beside the loop: a program that is not known yet is asked for
/// its --describe, and may be slow to answer.
void Runner::plan_next() {
  if (changes_.empty() || planning_->is_busy()) return;
  const auto& lines = changes_.front().commands;
  auto planned = std::make_shared<Planned>();
  planned->edits = commands_;
  for (const auto& line : lines)
    if (parse_command(line)->is_edit()) add_command(planned->edits, line);
  const auto reading = lines.empty() ? Reading::Anew : Reading::AsBefore;
  auto work = [this, planned, reading](int stop) {
    planned->changed = options_.replan(reading, planned->edits, plan_, stop);
    // Perhaps the file is right, and what was asked beside it does not go with it any more.
    if (!planned->changed.plan && reading == Reading::Anew && !planned->edits.empty())
      planned->alone = options_.replan(reading, {}, plan_, stop);
  };
  planning_->begin(std::move(work), [this, planned] { take_planned(*planned); });
}

void Runner::take_planned(Planned& planned) {
  if (is_stopping_) return;
  const auto change = std::move(changes_.front());
  changes_.pop_front();
  if (change.commands.empty()) {
    take_edit(planned);
  } else if (planned.changed.plan) {
    commands_ = std::move(planned.edits);
    change_to(std::move(*planned.changed.plan));
    carry_out(change.commands);
    change.answer({});
  } else {
    change.answer(planned.changed.problems);
  }
  plan_next();
}

void Runner::take_edit(Planned& planned) {
  auto& [edits, changed, alone] = planned;
  if (!changed.plan && planning_->is_stopped()) return;  // there is another edit
  if (alone && alone->plan) {
    for (const auto& line : changed.problems) say("graph: " + line);
    say("graph: the commands so far are forgotten");
    commands_.clear();
    changed = std::move(*alone);
  }
  files_->set_files(changed.files.empty() ? options_.files : changed.files);
  if (changed.plan) return change_to(std::move(*changed.plan));
  for (const auto& line : changed.problems) say("graph: " + line);
  say("graph: keeping the running version");
}

/// Answers who has asked for changes that will not be made.
void Runner::refuse_changes() {
  if (planning_) planning_->stop();
  for (const auto& change : std::exchange(changes_, {}))
    if (change.answer) change.answer({kIsStopping});
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
  say(has_changed ? "graph: changed" : "graph: unchanged");
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
