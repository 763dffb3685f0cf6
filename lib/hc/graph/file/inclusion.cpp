// SPDX-License-Identifier: Apache-2.0
// A graph within a graph: its names get that of its table before them.
#include <iterator>
#include <set>
#include <utility>

#include <hc/graph/file/tables.h>

namespace hc::internal {
namespace {

template <typename List>
std::set<std::string> names_of(const List& list) {
  std::set<std::string> names;
  for (const auto& each : list) names.insert(each.name);
  return names;
}

}  // namespace

Graph with_prefix(Graph graph, const std::string& name) {
  const std::string prefix = name + "_";
  const std::set<std::string> groups = names_of(graph.groups), frames = names_of(graph.frames);
  auto rename_port = [&](GraphPort& port) {
    if (port.uri.empty()) port.module = prefix + port.module;
  };
  // An input is one of this graph; another name may be that of a group out there.
  auto rename_addressee = [&](Addressee& addressee) {
    bool is_input = addressee.name.find('.') != std::string::npos;
    if (is_input || groups.contains(addressee.name)) addressee.name = prefix + addressee.name;
  };
  for (auto& module : graph.modules) {
    module.name = prefix + module.name;
    for (auto& [port, to] : module.to) rename_addressee(to.value);
  }
  for (auto& link : graph.links) {
    rename_port(link.from);
    rename_port(link.to);
  }
  for (auto& group : graph.groups) {
    group.name = prefix + group.name;
    for (auto& member : group.members) rename_addressee(member.value);
  }
  for (auto& frame : graph.frames) {
    frame.name = prefix + frame.name;
    if (frames.contains(frame.parent.value)) frame.parent.value = prefix + frame.parent.value;
    if (frame.moved_by) rename_port(frame.moved_by->value);
  }
  if (graph.workspace && !graph.workspace->value.empty())
    graph.workspace->value = prefix + graph.workspace->value;
  return graph;
}

void append(Graph& graph, Graph included, Problems& problems) {
  auto move_all = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  auto refuse_twice = [&](const auto& there, const auto& more, const std::string& what) {
    const std::set<std::string> names = names_of(there);
    for (const auto& each : more)
      if (names.contains(each.name))
        problems.add(each.place, what + " " + quoted_name(each.name) + " is there twice");
  };
  refuse_twice(graph.modules, included.modules, "module");
  refuse_twice(graph.groups, included.groups, "group");
  refuse_twice(graph.frames, included.frames, "frame");
  move_all(graph.modules, included.modules);
  move_all(graph.links, included.links);
  move_all(graph.groups, included.groups);
  move_all(graph.frames, included.frames);
  std::set<std::pair<std::string, std::int64_t>> modes;
  for (const auto& mode : graph.modes) modes.emplace(mode.name, mode.number);
  for (auto& mode : included.modes)  // one that both have is the same
    if (!modes.contains({mode.name, mode.number})) graph.modes.push_back(std::move(mode));
  if (included.workspace && graph.workspace)
    problems.add(included.workspace->place, "a graph has one workspace");
  if (!graph.workspace) graph.workspace = std::move(included.workspace);
}

}  // namespace hc::internal
