// SPDX-License-Identifier: Apache-2.0
// hc page: shows again what the modules of a running graph print for a person.
#include "common.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

void print_notices(const RunningGraph& graph) {
  const auto lines = command_graph(graph, {"notices"});
  if (lines.empty())
    throw Failure(hc::Code::NotFound, graph.text() +
                                          " has printed no URL of a page; hc graph add web web "
                                          "adds a page");
  for (const auto& line : lines) print(line + "\n");
}

}  // namespace

void add_page(CLI::App& app) {
  auto of = std::make_shared<std::string>();
  auto* verb = app.add_subcommand(
      "page", "Print the URL of the page of a running graph, which opens it once");
  add_of(*verb, *of);
  verb->callback([of] { print_notices(choose_running(*of)); });
}

}  // namespace tool
