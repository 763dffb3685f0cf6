// SPDX-License-Identifier: Apache-2.0
#include <graph/commands.h>

#include <algorithm>

#include <graph/file/fields.h>
#include <hc/base/suggestion.h>
#include <hc/base/uri.h>
#include <hc/contract/description.h>

namespace hc {
namespace {

/// Takes a word "KEY=VALUE" apart; nothing where it is none.
std::optional<std::pair<std::string, std::string>> pair_of(const std::string& word,
                                                           Problems& problems) {
  auto equals = word.find('=');
  if (equals != std::string::npos && equals > 0)
    return std::pair(word.substr(0, equals), word.substr(equals + 1));
  problems.add({}, "\"" + word + "\" is not KEY=VALUE");
  return std::nullopt;
}

void add_no_module(const Graph& graph, const std::string& name, Problems& problems) {
  problems.add({}, "no module \"" + name + "\"" + suggestion(name, graph.module_names()));
}

void add_module(Graph& graph, const GraphCommand& command, Problems& problems) {
  GraphModule module;
  module.name = command.words[0].substr(0, command.words[0].find('@'));
  module.program.value = command.words[1];
  if (module.name != command.words[0]) {
    module.host.value = command.words[0].substr(module.name.size() + 1);
    const auto hosts = graph.host_names();
    if (std::find(hosts.begin(), hosts.end(), module.host.value) == hosts.end())
      return problems.add(
          {}, "no host \"" + module.host.value + "\"" + suggestion(module.host.value, hosts));
  }
  if (!is_name(module.name))
    return problems.add({}, "module name \"" + module.name + "\" is not snake_case");
  if (graph.find(module.name) != nullptr)
    return problems.add({}, "module \"" + module.name + "\" already exists");
  if (graph.modules.size() >= kMaxModules)
    return problems.add({}, "a graph has at most " + std::to_string(kMaxModules) + " modules");
  for (std::size_t i = 2; i < command.words.size(); ++i)
    if (auto pair = pair_of(command.words[i], problems))
      module.parameters[pair->first] = {pair->second, {}};
  graph.modules.push_back(std::move(module));
}

void remove_module(Graph& graph, const std::string& name, Problems& problems) {
  if (graph.find(name) == nullptr) return add_no_module(graph, name, problems);
  std::erase_if(graph.modules, [&](const auto& module) { return module.name == name; });
  std::erase_if(graph.links, [&](const auto& link) {
    return link.from.module == name || link.to.module == name;
  });
}

void add_policy(GraphLink& link, const GraphCommand& command, Problems& problems) {
  static const std::vector<std::string> kKeys(kPolicyKeys.begin(), kPolicyKeys.end());
  Uri policy;
  for (std::size_t i = 2; i < command.words.size(); ++i) {
    auto pair = pair_of(command.words[i], problems);
    if (!pair) continue;
    if (std::find(kKeys.begin(), kKeys.end(), pair->first) == kKeys.end())
      problems.add(
          {}, "unknown key \"" + pair->first + "\" in a link" + suggestion(pair->first, kKeys));
    policy.options.push_back(*pair);
    link.policy[pair->first] = {pair->second, {}};
  }
  if (auto valid = check_policy(policy); !valid) problems.add({}, valid.error().detail);
}

/// A link to where readers come and go by hand makes no module wait, unless that was asked for.
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
  // The same link with another policy takes the place of the one before.
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
  if (count == 0) problems.add({}, "no link from " + command.words[0] + " to " + command.words[1]);
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
      return;
  }
}

}  // namespace hc
