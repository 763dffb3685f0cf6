// SPDX-License-Identifier: Apache-2.0
// hc run: runs a graph.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <hc/base/program.h>
#include <hc/base/suggestion.h>
#include <hc/graph/run.h>

#include "common.h"
#include "verbs.h"

namespace tool {
namespace {

struct Options {
  std::string file;
  std::vector<std::string> settings;
  bool quiet = false;
};

hc::Graph read_graph(const Options& options) {
  std::ifstream file(options.file, std::ios::binary);
  if (!file) throw Failure(hc::Error{hc::Code::NotFound, options.file + ": cannot be read"});
  std::string text(hc::kMaxGraphBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  auto graph = hc::parse_graph(text, options.file,
                               [](const char* name) -> const char* { return std::getenv(name); });
  if (!graph) throw Failure(graph.error());
  for (const auto& setting : options.settings)
    if (auto set = hc::set_parameter(*graph, setting); !set) throw Failure(set.error());
  return std::move(*graph);
}

/// Names of programs become paths; one with a slash is sought from the graph file's folder.
void resolve_programs(hc::Graph& graph) {
  for (auto& module : graph.modules) {
    std::string name = module.program;
    if (name.find('/') != std::string::npos && !name.starts_with('/'))
      name = (std::filesystem::path(graph.file).parent_path() / name).string();
    std::string program = find_program(name);
    if (program.empty() && std::filesystem::is_regular_file(name))
      throw Failure(hc::Error{hc::Code::Usage, fmt::format("{}:{}: {} may not be executed",
                                                           graph.file, module.line, name)});
    if (program.empty())
      throw Failure(
          hc::Error{hc::Code::Usage,
                    fmt::format("{}:{}: no program \"{}\"{}", graph.file, module.line,
                                module.program, hc::suggestion(module.program, module_names()))});
    module.program = program;
  }
}

void print_links(const hc::Plan& plan, const hc::RunReport& report) {
  std::size_t widest = 0;
  for (const auto& link : plan.links)
    widest = std::max(widest, link.from.text().size() + link.to.text().size() + 4);
  std::string text;
  for (std::size_t i = 0; i < plan.links.size(); ++i) {
    std::string name = plan.links[i].from.text() + " -> " + plan.links[i].to.text();
    const auto& sent = report.links[i].sent;
    std::string lost;
    if (sent.lost() > 0) lost = fmt::format("  {} lost ({})", sent.lost(), losses_in_words(sent));
    text += fmt::format("{:<{}}  {:>8} message{}  {:>9}{}\n", name, widest, sent.messages,
                        sent.messages == 1 ? " " : "s",
                        bytes_in_words(static_cast<double>(sent.bytes)), lost);
  }
  print(text);
}

void run(const Options& options) {
  hc::Graph graph = read_graph(options);
  resolve_programs(graph);
  auto plan = hc::make_plan(std::move(graph), hc::describe_program, hc::graph_token());
  if (!plan) throw Failure(plan.error());
  hc::RunOptions run_options;
  run_options.stop = hc::stop_descriptor();
  run_options.event = [&](std::string_view line) {
    bool is_event = line.ends_with(": started") || line.ends_with(": ended");
    if (!(options.quiet && is_event)) say(line);
  };
  auto report = hc::run_graph(*plan, run_options);
  if (!report) throw Failure(report.error());
  print_links(*plan, *report);
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* verb = app.add_subcommand("run", "Run a graph of modules");
  verb->add_option("graph", options->file, "a graph file (TOML)")->required();
  verb->add_option("--set", options->settings, "MODULE.PARAMETER=VALUE; may be repeated");
  verb->add_flag("--quiet", options->quiet, "do not tell which modules start and end");
  verb->callback([options] { run(*options); });
}

}  // namespace tool
