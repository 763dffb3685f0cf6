// SPDX-License-Identifier: Apache-2.0
// hc ports: lists the ports of a running graph, a graph file or a program.
#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include <graph/run.h>
#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>

#include "common.h"
#include "graph.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

struct PortsOptions {
  std::string what, of;
  bool json = false;
};

/// A program's description, as it prints it.
struct Described {
  std::string module;  // in its graph; empty: a program alone
  std::string text;
};

/// @param wanted  a module; empty: all.
std::vector<Described> describe_running(const std::string& of, const std::string& wanted) {
  const auto graph = choose_running(of);
  const auto state = state_of(graph);
  std::vector<Described> all;
  auto add = [&](const hc::ModuleState& module) {
    all.push_back({module.name, joined(command_graph(graph, {"describe " + module.name}))});
  };
  if (wanted.empty())
    std::ranges::for_each(state.modules, add);
  else
    add(find_module(state, wanted));
  return all;
}

/// @param what  a module of ours, a graph, or else another program, such as /usr/bin/head.
std::vector<Described> describe_word(const std::string& what) {
  auto known = module_names();
  hc::LoadOptions graph;
  graph.file = find_graph(what);
  if (std::ranges::find(known, what) != known.end() || !graph.file.ends_with(".toml")) {
    const auto program = find_program(what);
    if (!program.empty()) return {{"", value_or_fail(hc::describe_program(program), what)}};
    for (auto& name : shipped_graphs()) known.push_back(std::move(name));
    throw Failure(hc::Code::NotFound,
                  hc::format("no graph or program \"{}\"{}", what, hc::suggestion(what, known)));
  }
  std::vector<Described> all;
  for (const auto& module : look_at_plan("ports", graph).modules)
    all.push_back({module.name, module.description});
  return all;
}

/// Calls `add` for each port: its name, "input" or "output", and its number in the list of these.
template <typename Add>
void each_port(const std::string& module, const hc::Description& description, Add add) {
  const std::string prefix = module.empty() ? "" : module + ".";
  for (const auto& [kind, ports] :
       {std::pair("input", &description.inputs), std::pair("output", &description.outputs)})
    for (std::size_t i = 0; i < ports->size(); ++i) add(prefix, kind, (*ports)[i], i);
}

std::string as_lines(const std::vector<Described>& all) {
  std::string text;
  for (const auto& each : all)
    if (const auto description = hc::parse_description(each.text))
      each_port(each.module, *description,
                [&](auto& prefix, const std::string& kind, auto& port, auto i) {
                  auto json = nlohmann::ordered_json::parse(each.text)[kind + "s"][i];
                  json["name"] = prefix + port.name;
                  json["kind"] = kind;
                  text += json.dump() + "\n";
                });
  return text;
}

std::string as_table(const std::vector<Described>& all) {
  std::vector<std::array<std::string, 4>> rows;
  std::size_t widest = 0;
  for (const auto& each : all)
    if (const auto description = hc::parse_description(each.text))
      each_port(each.module, *description,
                [&](auto& prefix, const std::string& kind, auto& port, auto) {
                  rows.push_back({prefix + port.name, kind == "input" ? "in" : "out",
                                  hc::in_words(port) + (port.actor ? ", moves something" : ""),
                                  port.doc});
                  widest = std::max(widest, rows.back()[0].size());
                });
  std::string text;
  for (const auto& [name, kind, types, doc] : rows)
    text += hc::format("{:<{}}  {:<3}  {}{}\n", name, widest, kind, types,
                       doc.empty() ? "" : ": " + doc);
  return text;
}

}  // namespace

void add_ports(CLI::App& app) {
  auto options = std::make_shared<PortsOptions>();
  auto* verb = app.add_subcommand("ports", "List ports with their types");
  verb->add_option("what", options->what,
                   "a program, a graph file, or the name of a shipped graph; with --of a module of "
                   "that graph (default: the running graph)");
  add_of(*verb, options->of);
  verb->add_flag("--json", options->json,
                 "a line of JSON for each port: as --describe prints it, and its `kind`");
  verb->callback([options] {
    const bool is_running = options->what.empty() || !options->of.empty();
    const auto all =
        is_running ? describe_running(options->of, options->what) : describe_word(options->what);
    print(options->json ? as_lines(all) : as_table(all));
  });
}

}  // namespace tool
