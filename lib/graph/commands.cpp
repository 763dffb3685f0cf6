// SPDX-License-Identifier: Apache-2.0
#include <graph/graph_file.h>

#include <algorithm>

#include <graph/file/fields.h>
#include <hc/base/suggestion.h>
#include <hc/base/uri.h>
#include <hc/contract/description.h>

namespace hc {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// Parses the words after the first two as KEY=VALUE.
Pairs pairs_of(const GraphCommand& command, Problems& problems) {
  Pairs pairs;
  for (std::size_t i = 2; i < command.words.size(); ++i) {
    const std::string& word = command.words[i];
    const auto equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      problems.add({}, "\"{}\" is not KEY=VALUE", word);
    else
      pairs.emplace_back(word.substr(0, equals), word.substr(equals + 1));
  }
  return pairs;
}

void add_module(Graph& graph, const GraphCommand& command, Problems& problems) {
  GraphModule module;
  module.name = command.words[0].substr(0, command.words[0].find('@'));
  module.program.value = command.words[1];
  if (module.name != command.words[0]) {
    module.host.value = command.words[0].substr(module.name.size() + 1);
    if (find_named(graph.hosts, module.host.value) == nullptr)
      return problems.add({}, "no host \"{}\"{}", module.host.value,
                          suggestion(module.host.value, names_of(graph.hosts)));
  }
  if (!is_name(module.name))
    return problems.add({}, "module name \"{}\" is not snake_case", module.name);
  if (graph.find(module.name) != nullptr)
    return problems.add({}, "module \"{}\" already exists", module.name);
  if (graph.modules.size() >= kMaxModules)
    return problems.add({}, "a graph has at most {} modules", kMaxModules);
  for (const auto& [key, value] : pairs_of(command, problems)) module.parameters[key] = {value, {}};
  graph.modules.push_back(std::move(module));
}

void remove_module(Graph& graph, const std::string& name, Problems& problems) {
  if (graph.find(name) == nullptr)
    return problems.add({}, "no module \"{}\"{}", name, suggestion(name, names_of(graph.modules)));
  std::erase_if(graph.modules, [&](const auto& module) { return module.name == name; });
  std::erase_if(graph.links, [&](const auto& link) {
    return link.from.module == name || link.to.module == name;
  });
}

void add_policy(GraphLink& link, const GraphCommand& command, Problems& problems) {
  static const std::vector<std::string> kKeys(kPolicyKeys.begin(), kPolicyKeys.end());
  Uri policy;
  policy.options = pairs_of(command, problems);
  for (const auto& [key, value] : policy.options) {
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
      problems.add({}, "unknown key \"{}\" in a link{}", key, suggestion(key, kKeys));
    link.policy[key] = {value, {}};
  }
  if (auto valid = check_policy(policy); !valid) problems.add({}, valid.error().detail);
}

/// Default policy of a link to a URI where readers come and go: never make the module wait.
void add_observer_policy(GraphLink& link) {
  auto uri = parse_uri(link.to.uri);
  if (!uri || !(uri->scheme == "shm" || uri->scheme.ends_with("-listen"))) return;
  for (auto [key, value] : {std::pair("keep", "latest"), {"readers", "0"}})
    if (uri->option(key, "").empty()) link.policy.try_emplace(key, Lined<std::string>{value, {}});
}

void add_link(Graph& graph, const GraphCommand& command, Problems& problems) {
  auto from = internal::parse_port(command.words[0], true);
  auto to = internal::parse_port(command.words[1], true);
  for (const auto* end : {&from, &to})
    if (!*end) problems.add({}, end->error().detail);
  if (!from || !to) return;
  if (!from->uri.empty() && !to->uri.empty())
    return problems.add({}, "a link needs a module at one of its ends");
  GraphLink link;
  link.from = *from;
  link.to = *to;
  add_policy(link, command, problems);
  add_observer_policy(link);
  // A link between the same ports gets the new policy.
  auto is_same = [&](const GraphLink& each) {
    return each.from.text() == from->text() && each.to.text() == to->text();
  };
  auto before = std::find_if(graph.links.begin(), graph.links.end(), is_same);
  if (before == graph.links.end())
    graph.links.push_back(std::move(link));
  else
    before->policy = std::move(link.policy);
}

void remove_link(Graph& graph, const GraphCommand& command, Problems& problems) {
  auto count = std::erase_if(graph.links, [&](const auto& link) {
    return link.from.text() == command.words[0] && link.to.text() == command.words[1];
  });
  if (count == 0) problems.add({}, "no link from {} to {}", command.words[0], command.words[1]);
}

}  // namespace

void apply_command(Graph& graph, const GraphCommand& command, Problems& problems) {
  using Verb = GraphCommand::Verb;
  const auto& words = command.words;
  switch (command.verb) {
    case Verb::Set:
      return set_parameter(graph, {words[0], words[1], words[2]}, problems);
    case Verb::Add:
      return add_module(graph, command, problems);
    case Verb::Remove:
      return remove_module(graph, words[0], problems);
    case Verb::Link:
      return add_link(graph, command, problems);
    case Verb::Unlink:
      return remove_link(graph, command, problems);
    case Verb::Restart:
    case Verb::Stop:
    case Verb::Describe:
    case Verb::Observe:
    case Verb::Feed:
    case Verb::Notices:
      return;
  }
}

}  // namespace hc
