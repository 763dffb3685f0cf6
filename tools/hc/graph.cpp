// SPDX-License-Identifier: Apache-2.0
#include "graph.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>

#include <hc/base/suggestion.h>
#include <hc/graph/run.h>

#include "common.h"

namespace tool {
namespace {

hc::Result<std::string> read_text(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) return hc::Error{hc::Code::NotFound, name + ": cannot be read"};
  std::string text(hc::kMaxGraphBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// What is included is a file, so that nothing is waited for.
hc::Result<std::string> read_included(const std::string& name) {
  if (!std::filesystem::is_regular_file(name))
    return hc::Error{hc::Code::NotFound, name + ": cannot be read"};
  return read_text(name);
}

/// Names of programs become paths; one with a slash is sought from the folder of the file where it
/// stands.
void resolve_programs(hc::Graph& graph, hc::Problems& problems) {
  for (auto& module : graph.modules) {
    std::string name = module.program;
    if (name.find('/') != std::string::npos && !name.starts_with('/'))
      name =
          (std::filesystem::path(problems.file(module.place.file)).parent_path() / name).string();
    std::string program = find_program(name);
    if (program.empty())
      problems.add(module.place, std::filesystem::is_regular_file(name)
                                     ? name + " may not be executed"
                                     : fmt::format("no program \"{}\"{}", module.program,
                                                   hc::suggestion(module.program, module_names())));
    module.program = program;
  }
}

}  // namespace

void add_graph_options(CLI::App& verb, GraphOptions& options) {
  verb.add_option("graph", options.file, "a graph file (TOML)")->required();
  verb.add_option("--set", options.settings, "MODULE.PARAMETER=VALUE; may be repeated");
}

hc::Plan make_plan(std::string_view verb, const GraphOptions& options) {
  hc::Problems problems(options.file);
  auto environment = [](const char* name) -> const char* { return std::getenv(name); };
  auto text = read_text(options.file);
  if (!text) throw Failure(text.error());
  hc::Graph graph = hc::parse_graph(*text, environment, problems, read_included);
  for (const auto& setting : options.settings) hc::set_parameter(graph, setting, problems);
  resolve_programs(graph, problems);
  std::map<std::string, hc::Result<std::string>> described;  // each program is asked once
  auto describe = [&](const std::string& program) {
    auto known = described.find(program);
    if (known == described.end())
      known = described.emplace(program, hc::describe_program(program)).first;
    return known->second;
  };
  auto plan = hc::make_plan(std::move(graph), describe, hc::graph_token(), problems);
  if (problems.empty()) return plan;
  for (const auto& line : problems.lines())
    say(fmt::format("hc {}: {}", verb, hc::Error{hc::Code::Usage, line}.text()));
  throw Failure(2);
}

}  // namespace tool
