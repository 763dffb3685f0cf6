// SPDX-License-Identifier: Apache-2.0
#include <graph/run/graph_changes.h>

#include <algorithm>
#include <utility>

#include <hc/contract/description.h>
#include <hc/contract/graph_command.h>

namespace hc::internal {
namespace {

constexpr const char* kIsStopping = "the graph is stopping";

constexpr std::size_t kMostChanges = 100;  // queued while a slow program describes itself

using Commands = GraphChanges::Commands;

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

Status GraphChanges::watch_files() {
  if (loader_ == nullptr || graph_.files.empty()) return {};
  files_ = HC_TRY(FileWatch::make(loop_, graph_.files, [this] { reload(); }));
  return {};
}

/// Reloads the graph after a change of its files.
void GraphChanges::reload() {
  if (is_stopping_) return;
  const auto& file = graph_.files.front();
  const bool is_gone = !files_->was_there(file);
  if (is_gone && !is_file_gone_)
    log_.add(file + " has been removed; keeping the running version", Level::Warning);
  is_file_gone_ = is_gone;
  if (is_gone) return;
  auto is_reload = [](const Change& change) { return change.commands.empty(); };
  // A queued reload will read the newest files; one in progress is out of date.
  if (!changes_.empty() && std::any_of(changes_.begin() + 1, changes_.end(), is_reload)) return;
  if (!changes_.empty() && is_reload(changes_.front())) planning_.stop();
  changes_.push_back({});
  begin();
}

void GraphChanges::obey(const std::vector<std::string>& lines, const GraphServer::Reply& reply) {
  auto has_module = [&](const std::string& name) {
    return find_named(plan_.modules, name) != nullptr;
  };
  std::vector<std::string> wrong;
  Commands commands;
  for (const auto& line : lines) {
    auto command = parse_graph_command(line);
    if (!command)
      wrong.push_back(command.error().detail);
    else if (command->is_question() && lines.size() > 1)
      wrong.push_back(line + ": send it alone in a message");
    else if (command->is_question())
      return reply(callbacks_.answer(*command));
    else if (command->verb == GraphCommand::Verb::Restart && !has_module(command->words[0]))
      wrong.push_back("no module \"" + command->words[0] + "\"");
    else
      commands.push_back(std::move(*command));
  }
  if (lines.empty()) wrong.emplace_back("there is no command");
  if (is_stopping_) wrong.emplace_back(kIsStopping);
  if (changes_.size() >= kMostChanges) wrong.emplace_back("too many queued changes; try again");
  if (!wrong.empty()) return reply({false, wrong});
  if (!has_edits(commands)) {
    callbacks_.carry_out(commands);
    return reply({true, {}});
  }
  changes_.push_back({std::move(commands), reply});
  begin();
}

/// Makes queued changes up to the first that needs planning, which happens on another thread, as a
/// new program may be slow to describe itself.
void GraphChanges::begin() {
  while (!changes_.empty() && !is_stopping_ && !planning_.is_busy()) {
    const Commands& commands = changes_.front().commands;
    if (commands.empty())
      return begin_planning([this](int stop) { return loader_->load(&plan_, stop); });
    Graph graph = graph_;
    Problems problems(graph.files);
    for (const auto& command : commands) apply_command(graph, command, problems);
    GraphAnswer answer{problems.empty(), problems.lines()};
    if (answer.is_ok && only_set(commands))
      answer = callbacks_.set_parameters(commands);
    else if (answer.is_ok && loader_ != nullptr)
      return begin_planning(
          [this, graph = std::move(graph)](int stop) { return loader_->plan(graph, plan_, stop); });
    else if (answer.is_ok)
      answer = {false, {"this graph cannot be changed"}};
    if (answer.is_ok) graph_ = std::move(graph);
    end(answer);
  }
}

void GraphChanges::begin_planning(std::function<Result<LoadedGraph>(int stop)> plan) {
  auto planning = run_aside(loop_, std::move(plan),
                            [this](Result<LoadedGraph> loaded) { take_planned(loaded); });
  if (!planning) {
    end({false, {planning.error().text()}});
    return begin();
  }
  planning_ = std::move(*planning);
}

void GraphChanges::take_planned(Result<LoadedGraph>& loaded) {
  if (is_stopping_) return;
  const bool is_reload = changes_.front().commands.empty();
  std::vector<std::string> wrong;
  if (!loaded)
    wrong.push_back(loaded.error().detail);
  else if (!loaded->plan)
    wrong = loaded->problems;
  if (wrong.empty()) {
    graph_ = std::move(loaded->graph);
    callbacks_.change_to(std::move(*loaded->plan));
  } else if (is_reload && !planning_.is_stopped()) {  // otherwise a newer edit follows
    for (const auto& line : wrong) log_.add(line, Level::Warning);
    log_.add("keeping the running version", Level::Warning);
  }
  if (is_reload && loaded)
    files_->set_files(loaded->graph.files.empty() ? graph_.files : loaded->graph.files);
  end({wrong.empty(), wrong});
  begin();
}

/// Completes the first change and answers it.
void GraphChanges::end(const GraphAnswer& answer) {
  const Change change = std::move(changes_.front());
  changes_.pop_front();
  if (answer.is_ok) callbacks_.carry_out(change.commands);
  if (change.reply) change.reply(answer);
}

void GraphChanges::stop() {
  is_stopping_ = true;
  planning_.stop();
  for (const auto& change : std::exchange(changes_, {}))
    if (change.reply) change.reply({false, {kIsStopping}});
}

}  // namespace hc::internal
