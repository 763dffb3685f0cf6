// SPDX-License-Identifier: Apache-2.0
// hc ps: lists the graphs that run on this host.
#include <unistd.h>

#include <algorithm>

#include <hc/base/format.h>

#include "common.h"
#include "observer.h"
#include "screen.h"
#include "verbs.h"

namespace tool {
namespace {

/// @param name  for --of.
std::string row(const std::string& name, const hc::GraphState& state, bool is_plain) {
  auto count = [&](hc::ModuleStatus status) {
    return std::count_if(state.modules.begin(), state.modules.end(),
                         [&](const auto& module) { return module.status == status; });
  };
  std::string status = state.is_stopping ? "stopping" : "running";
  for (auto trouble : {hc::ModuleStatus::Stalled, hc::ModuleStatus::GivenUp})
    if (auto number = count(trouble); number > 0)
      status += hc::format(", {} {}", number, hc::name(trouble));
  if (const auto stopped = state.stopped_in_words(); !stopped.empty()) status += ", " + stopped;
  const bool is_red = std::any_of(state.modules.begin(), state.modules.end(), is_in_trouble);
  const bool is_painted = is_red && !is_plain;
  const auto focus = state.focus_in_words();
  return hc::format("{}{:<16} {:>7} {:>9} {:>4}/{:<4} {:<10} {}{}\n", is_painted ? "\x1b[31m" : "",
                    name, state.process, seconds_in_words(state.uptime),
                    count(hc::ModuleStatus::Running), state.modules.size(),
                    focus.empty() ? "-" : focus, status, is_painted ? "\x1b[0m" : "");
}

bool is_running(const RunningGraph& graph) {
  const auto graphs = find_running();
  return std::ranges::any_of(graphs, [&](const auto& each) { return each.text() == graph.text(); });
}

void ps(bool as_json) {
  const bool is_plain = ::isatty(STDOUT_FILENO) == 0;
  std::string text;
  if (!as_json)
    text = hc::format("{:<16} {:>7} {:>9} {:>4}/{:<4} {:<10} {}\n", "GRAPH", "PROCESS", "RUNS FOR",
                      "UP", "ALL", "FOCUS", "STATUS");
  bool is_silent = false;
  const auto graphs = find_running();
  for (const auto& graph : graphs) {
    const bool is_only = std::count_if(graphs.begin(), graphs.end(), [&](const auto& each) {
                           return each.name == graph.name;
                         }) == 1;
    const std::string name = is_only ? graph.name : graph.text();
    try {
      auto state = Observer(graph).next();
      if (state) text += as_json ? to_json(*state) + "\n" : row(name, *state, is_plain);
      if (state || !is_running(graph)) continue;
    } catch (const Failure& failure) {
      if (!is_running(graph)) continue;  // has just ended
      say(hc::format("hc ps: {}: {}", name, failure.what()));
    }
    is_silent = true;  // list the others before failing
  }
  print(text);
  if (is_silent) throw Failure(1);
}

}  // namespace

void add_ps(CLI::App& app) {
  auto as_json = std::make_shared<bool>();
  auto* verb = app.add_subcommand("ps", "List the running graphs of this host");
  verb->add_flag("--json", *as_json, "print the state of each graph as a line of JSON");
  verb->callback([as_json] { ps(*as_json); });
}

}  // namespace tool
