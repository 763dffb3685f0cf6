// SPDX-License-Identifier: Apache-2.0
// A graph within a graph: its names get that of its table before them.
#include <algorithm>

#include <hc/graph/tables.h>

namespace hc::internal {
namespace {

template <typename List>
bool has_name(const List& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const auto& each) { return each.name == name; });
}

}  // namespace

Graph with_prefix(Graph graph, const std::string& name) {
  const std::string prefix = name + "_";
  const Graph original = graph;
  auto rename_port = [&](GraphPort& port) {
    if (port.uri.empty()) port.module = prefix + port.module;
  };
  // An input is one of this graph; another name may be that of a group out there.
  auto rename_addressee = [&](Addressee& addressee) {
    bool is_input = addressee.name.find('.') != std::string::npos;
    if (is_input || has_name(original.groups, addressee.name))
      addressee.name = prefix + addressee.name;
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
    if (has_name(original.frames, frame.parent.value))
      frame.parent.value = prefix + frame.parent.value;
    if (frame.moved_by) rename_port(frame.moved_by->value);
  }
  if (graph.workspace) graph.workspace->value = prefix + graph.workspace->value;
  return graph;
}

void append(Graph& graph, Graph included, Problems& problems) {
  auto move_all = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  auto refuse_twice = [&](const auto& there, const auto& more, const std::string& what) {
    for (const auto& each : more)
      if (has_name(there, each.name))
        problems.add(each.place, what + " " + in_quotes(each.name) + " is there twice");
  };
  refuse_twice(graph.modules, included.modules, "module");
  refuse_twice(graph.groups, included.groups, "group");
  refuse_twice(graph.frames, included.frames, "frame");
  move_all(graph.modules, included.modules);
  move_all(graph.links, included.links);
  move_all(graph.groups, included.groups);
  move_all(graph.frames, included.frames);
  for (auto& mode : included.modes) {  // one that both have is the same
    bool is_there = std::any_of(graph.modes.begin(), graph.modes.end(), [&](const GraphMode& each) {
      return each.name == mode.name && each.number == mode.number;
    });
    if (!is_there) graph.modes.push_back(std::move(mode));
  }
  if (included.workspace && graph.workspace)
    problems.add(included.workspace->place, "a graph has one workspace");
  if (!graph.workspace) graph.workspace = std::move(included.workspace);
}

}  // namespace hc::internal
