// SPDX-License-Identifier: Apache-2.0
// hc run: runs a graph.
#include <fmt/format.h>

#include <algorithm>

#include <hc/base/program.h>
#include <hc/graph/run.h>

#include "common.h"
#include "graph.h"
#include "verbs.h"

namespace tool {
namespace {

struct Options {
  GraphOptions graph;
  bool quiet = false;
};

void print_links(const hc::Plan& plan, const hc::RunReport& report) {
  std::size_t widest = 0;
  for (const auto& link : plan.links)
    widest = std::max(widest, link.from.size() + link.to.size() + 4);
  std::string text;
  for (std::size_t i = 0; i < plan.links.size(); ++i) {
    std::string name = plan.links[i].from + " -> " + plan.links[i].to;
    const auto& sent = report.links[i];
    std::string lost;
    if (sent.lost() > 0) lost = fmt::format("  {} lost ({})", sent.lost(), losses_in_words(sent));
    text += fmt::format("{:<{}}  {:>8} message{}  {:>9}{}\n", name, widest, sent.messages,
                        sent.messages == 1 ? " " : "s",
                        bytes_in_words(static_cast<double>(sent.bytes)), lost);
  }
  print(text);
}

void run(const Options& options) {
  auto plan = make_plan("run", options.graph);
  hc::RunOptions run_options;
  run_options.stop = hc::stop_descriptor();
  run_options.event = [&](std::string_view line) {
    bool is_event = line.ends_with(": started") || line.ends_with(": ended");
    if (!(options.quiet && is_event)) say(line);
  };
  auto report = hc::run_graph(plan, run_options);
  if (!report) throw Failure(report.error());
  print_links(plan, *report);
}

}  // namespace

void add_run(CLI::App& app) {
  auto options = std::make_shared<Options>();
  auto* verb = app.add_subcommand("run", "Run a graph of modules");
  add_graph_options(*verb, options->graph);
  verb->add_flag("--quiet", options->quiet, "do not tell which modules start and end");
  verb->callback([options] { run(*options); });
}

}  // namespace tool
