// SPDX-License-Identifier: Apache-2.0
#include "graph.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include <hc/base/suggestion.h>
#include <hc/graph/run.h>

#include "common.h"

namespace tool {
namespace {

std::string read_text(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) throw Failure(hc::Error{hc::Code::NotFound, name + ": cannot be read"});
  std::string text(hc::kMaxGraphBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// Names of programs become paths; one with a slash is sought from the graph file's folder.
void resolve_programs(hc::Graph& graph, hc::Problems& problems) {
  for (auto& module : graph.modules) {
    std::string name = module.program;
    if (name.find('/') != std::string::npos && !name.starts_with('/'))
      name = (std::filesystem::path(graph.file).parent_path() / name).string();
    std::string program = find_program(name);
    if (program.empty())
      problems.add(module.line, std::filesystem::is_regular_file(name)
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
  hc::Graph graph = hc::parse_graph(read_text(options.file), environment, problems);
  for (const auto& setting : options.settings) hc::set_parameter(graph, setting, problems);
  resolve_programs(graph, problems);
  auto plan = hc::make_plan(std::move(graph), hc::describe_program, hc::graph_token(), problems);
  if (problems.empty()) return plan;
  for (const auto& line : problems.lines())
    say(fmt::format("hc {}: {}", verb, hc::Error{hc::Code::Usage, line}.text()));
  throw Failure(2);
}

}  // namespace tool
