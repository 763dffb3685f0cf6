// SPDX-License-Identifier: Apache-2.0
// Inclusion of a graph; the name of its table becomes a prefix of its names.
#include <algorithm>
#include <iterator>
#include <set>

#include <graph/file/tables.h>

namespace hc::internal {
namespace {

template <typename List>
std::set<std::string> name_set(const List& list) {
  std::set<std::string> names;
  for (const auto& each : list) names.insert(each.name);
  return names;
}

}  // namespace

Graph with_prefix(Graph graph, const std::string& name) {
  const std::string prefix = name + "_";
  const std::set<std::string> frames = name_set(graph.frames);
  auto rename = [&](std::string& module) {
    if (!module.empty()) module = prefix + module;
  };
  for (auto& module : graph.modules) {
    rename(module.name);
    module.group = module.group.empty() ? name : prefix + module.group;
    module.prefix = prefix + module.prefix;
    rename(module.workspace);
    for (auto& [port, to] : module.to)
      if (to.value.name != "all") rename(to.value.name);
  }
  for (auto& link : graph.links) {
    rename(link.from.module);
    rename(link.to.module);
  }
  for (auto& frame : graph.frames) {
    rename(frame.name);
    frame.prefix = prefix + frame.prefix;
    if (frames.contains(frame.parent.value)) rename(frame.parent.value);
    if (frame.moved_by) rename(frame.moved_by->value.module);
  }
  for (auto& workspace : graph.workspaces) rename(workspace.value);
  return graph;
}

void append(Graph& graph, Graph included, Problems& problems) {
  auto move_all = [](auto& to, auto& from) {
    to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
  };
  auto refuse_duplicates = [&](const auto& there, const auto& more, const std::string& what) {
    const std::set<std::string> names = name_set(there);
    for (const auto& each : more)
      if (names.contains(each.name))
        problems.add(each.place, "duplicate " + what + " " + quoted_name(each.name));
  };
  refuse_duplicates(graph.modules, included.modules, "module");
  refuse_duplicates(graph.frames, included.frames, "frame");
  std::erase_if(included.modes, [&](const GraphMode& mode) {  // both may declare the same
    return std::any_of(graph.modes.begin(), graph.modes.end(), [&](const GraphMode& each) {
      return each.name == mode.name && each.number == mode.number;
    });
  });
  // The including file's declaration of a host overrides the included one.
  std::erase_if(included.hosts, [&](const GraphHost& host) {
    return std::any_of(graph.hosts.begin(), graph.hosts.end(), [&](const GraphHost& each) {
      return each.name == host.name && problems.file(each.place.file) == graph.file;
    });
  });
  refuse_duplicates(graph.hosts, included.hosts, "host");
  move_all(graph.hosts, included.hosts);
  move_all(graph.modules, included.modules);
  move_all(graph.links, included.links);
  move_all(graph.frames, included.frames);
  move_all(graph.modes, included.modes);
  move_all(graph.workspaces, included.workspaces);
  graph.is_whole = graph.is_whole && included.is_whole;
}

}  // namespace hc::internal
