// SPDX-License-Identifier: Apache-2.0
#include "observer.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>
#include <hc/os/program.h>
#include <hc/os/wait_readable.h>

#include "common.h"

namespace tool {
namespace {

/// A graph sends its state twice a second; after this silence it may be stopped.
constexpr std::chrono::milliseconds kSilence{5000};

bool is_of_this_terminal(int process) {
  return ::getsid(process) == ::getsid(0);
}

bool is_of_this_folder(int process) {
  std::error_code unknown;
  const auto folder = std::filesystem::read_symlink(hc::format("/proc/{}/cwd", process), unknown);
  return !unknown && folder == std::filesystem::current_path(unknown);
}

}  // namespace

RunningGraph choose_running(const std::string& wanted) {
  const char* variable = std::getenv("HC_GRAPH");
  const std::string name = !wanted.empty() || variable == nullptr ? wanted : variable;
  auto graphs = find_running();
  const auto names = hc::names_of(graphs);
  std::erase_if(graphs, [&](const auto& graph) {
    return !name.empty() && graph.name != name && graph.text() != name;
  });
  if (graphs.empty())
    throw Failure(hc::Code::NotFound, name.empty() ? "no graph is running here"
                                                   : hc::format("no graph \"{}\" is running{}",
                                                                name, hc::suggestion(name, names)));
  for (bool (*is_near)(int) : {is_of_this_terminal, is_of_this_folder}) {
    if (graphs.size() == 1 || !name.empty()) break;
    std::vector<RunningGraph> near;
    for (const auto& graph : graphs)
      if (is_near(graph.process)) near.push_back(graph);
    if (near.size() == 1) return near.front();
  }
  if (graphs.size() == 1) return graphs.front();
  std::vector<std::string> list(graphs.size());
  std::ranges::transform(graphs, list.begin(), [](const auto& graph) { return graph.text(); });
  throw Failure(hc::Code::Invalid, "several graphs are running; pass --of NAME: " + joined(list));
}

Observer::Observer(const RunningGraph& graph)
    : loop_(value_or_fail(hc::Loop::make(), graph.text())), client_(*loop_, graph) {
  const auto watched = client_.watch({[this](const auto& state, auto) {
                                        state_ = state;
                                        is_new_ = true;
                                      },
                                      [](const auto&, auto) {}, [this] { has_ended_ = true; }});
  if (!watched) throw Failure(watched.error());
}

std::optional<hc::GraphState> Observer::next(const std::vector<int>& inputs) {
  std::vector<int> descriptors = {loop_->descriptor()};
  descriptors.insert(descriptors.end(), inputs.begin(), inputs.end());
  for (is_new_ = false; !is_new_ && !has_ended_;) {
    const auto ready = hc::wait_readable(descriptors, hc::stop_descriptor(), kSilence);
    if (!ready && ready.error().code == hc::Code::Stopped) return std::nullopt;
    if (!ready) throw Failure(ready.error());
    if (*ready == descriptors.size())
      throw Failure(hc::Code::Closed,
                    client_.graph().text() + " has not answered for 5 s; it may be stopped");
    if (*ready > 0) return state_;
    if (auto turned = loop_->turn(std::chrono::milliseconds(0)); !turned)
      throw Failure(turned.error());
  }
  if (is_new_) return state_;
  return std::nullopt;
}

std::optional<hc::GraphState> Observer::next_measured() {
  constexpr int kUnmeasured = 2;  // the first precedes the observer, the second starts measuring
  for (int i = 0; i < kUnmeasured; ++i)
    if (!next()) return std::nullopt;
  return next();
}

hc::GraphState state_of(const RunningGraph& graph, bool is_measured) {
  Observer observer(graph);
  auto state = is_measured ? observer.next_measured() : observer.next();
  if (!state) throw Failure(hc::Code::Closed, graph.text() + " has ended");
  return std::move(*state);
}

const hc::ModuleState& find_module(const hc::GraphState& state, const std::string& name) {
  if (const auto* found = hc::find_named(state.modules, name)) return *found;
  throw Failure(hc::Code::Invalid, hc::format("no module \"{}\"{}", name,
                                              hc::suggestion(name, hc::names_of(state.modules))));
}

std::vector<std::string> command_graph(const RunningGraph& graph,
                                       const std::vector<std::string>& commands) {
  auto answer = value_or_fail(hc::ask(graph, commands, hc::stop_descriptor()), graph.text());
  if (answer.is_ok) return answer.rows;
  for (std::size_t i = 0; i + 1 < answer.rows.size(); ++i) say("hc: " + answer.rows[i]);
  throw Failure(hc::Code::Invalid, answer.rows.back());
}

std::unique_ptr<hc::Source> open_port(const RunningGraph& graph, const std::string& port) {
  return value_or_fail(hc::open_tap(graph, port, link_options()));
}

}  // namespace tool
