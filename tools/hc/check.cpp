// SPDX-License-Identifier: Apache-2.0
// hc check: reports all problems of a graph and its hosts, without starting it.

#include <hc/base/format.h>

#include "common.h"
#include "examination.h"
#include "graph.h"
#include "verbs.h"

namespace tool {

void add_check(CLI::App& app) {
  auto options = std::make_shared<hc::LoadOptions>();
  auto* verb = app.add_subcommand("check", "Check a graph file, without starting anything");
  add_graph_options(*verb, *options);
  verb->callback([options] {
    const auto hosts = make_hosts();
    auto plan = load_plan("check", *options, hosts.get());
    for (const auto& line : plan.warnings) say(hc::format("hc check: warning: {}", line));
    bool is_missing = false;
    for (const auto& finding : diagnose(plan, *hosts)) {
      if (finding.mark != Mark::Missing) continue;
      say(hc::format("hc check: error: {}: {}", finding.what, finding.text));
      is_missing = true;
    }
    if (is_missing) throw Failure(2);
    print(hc::format(
        "{}: {}, {}: {}\n", options->file, counted(plan.modules.size(), "module"),
        counted(plan.links.size(), "link"),
        plan.warnings.empty() ? "no problems found" : counted(plan.warnings.size(), "warning")));
  });
}

}  // namespace tool
