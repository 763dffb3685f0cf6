// SPDX-License-Identifier: Apache-2.0
// hc ps: the graphs that run on this host.
#include <fmt/format.h>

#include "common.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

std::string row(const nlohmann::json& state) {
  std::size_t running = 0, given_up = 0, stalled = 0;
  for (const auto& module : state.at("modules")) {
    auto status = module.at("status").get<std::string>();
    running += status == "running" ? 1 : 0;
    given_up += status == "given up" ? 1 : 0;
    stalled += status == "stalled" ? 1 : 0;
  }
  std::string status = state.at("status");
  if (stalled > 0) status += fmt::format(", {} stalled", stalled);
  if (given_up > 0) status += fmt::format(", {} given up", given_up);
  const auto& focus = state.at("focus");
  return fmt::format("{:<16} {:>7} {:>9} {:>4}/{:<4} {:<10} {}\n",
                     state.at("graph").get<std::string>(), state.at("pid").get<int>(),
                     seconds_in_words(state.at("uptime").get<double>()), running,
                     state.at("modules").size(),
                     focus.is_null() ? "-" : focus.at("mode").get<std::string>(), status);
}

}  // namespace

void add_ps(CLI::App& app) {
  auto* verb = app.add_subcommand("ps", "List the graphs that run on this host");
  verb->callback([] {
    std::string text = fmt::format("{:<16} {:>7} {:>9} {:>4}/{:<4} {:<10} {}\n", "GRAPH", "PROCESS",
                                   "RUNS FOR", "UP", "ALL", "FOCUS", "STATUS");
    for (const auto& graph : find_running()) {
      try {
        if (auto state = Observer(graph).next()) text += row(*state);
      } catch (const Failure& failure) {
        // One of another user, or one that has just ended; the others are of interest even so.
        text += fmt::format("{:<16} {:>7} {}\n", graph.name, graph.process, failure.what());
      }
    }
    print(text);
  });
}

}  // namespace tool
