// SPDX-License-Identifier: Apache-2.0
// hc check: reports all problems of a graph and its hosts, without starting it.

#include <hc/base/format.h>

#include "common.h"
#include "doctor_hosts.h"
#include "graph.h"
#include "verbs.h"

namespace tool {
namespace {

/// Warnings of missing or unreadable files on this machine that modules would read. Devices are for
/// `hc doctor`: they come and go.
std::vector<std::string> warn_of_files(const hc::Plan& plan) {
  std::vector<std::string> warnings;
  for (const auto& [module, text, question] : needs_of(part_of(plan, "")).places) {
    if (!question.starts_with("read ") || question.starts_with("read /dev/")) continue;
    if (const auto problem = problem_of(question); !problem.empty())
      warnings.push_back(hc::format("{}: {}{}", module, text, problem));
  }
  return warnings;
}

}  // namespace

void add_check(CLI::App& app) {
  auto options = std::make_shared<hc::LoadOptions>();
  auto* verb = app.add_subcommand("check", "Check a graph file, without starting anything");
  add_graph_options(*verb, *options);
  verb->callback([options] {
    const auto hosts = make_hosts();
    auto plan = load_plan("check", *options, hosts.get());
    for (auto& line : warn_of_files(plan)) plan.warnings.push_back(std::move(line));
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
