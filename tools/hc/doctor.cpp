// SPDX-License-Identifier: Apache-2.0
// hc doctor: checks this machine, and the requirements of a graph.
#include <graph/run.h>

#include "common.h"
#include "doctor_hosts.h"
#include "graph.h"
#include "verbs.h"

namespace tool {
namespace {

/// Findings about a graph file and, if it has a plan, about other hosts; also sets the needs here.
std::vector<Finding> examine_graph(hc::LoadOptions options, Needs& needs) {
  const auto hosts = make_hosts();
  options.hosts = hosts.get();
  const auto planned = value_or_fail(hc::make_loader(options)->load(nullptr, -1));
  std::vector<Finding> findings;
  for (const auto& problem : planned.problems) findings.push_back({Mark::Wrong, "graph", problem});
  if (planned.plan) {
    findings.push_back({Mark::Ok, "graph", options.file + ": no problems found"});
    needs = needs_of(part_of(*planned.plan, ""));
    for (auto& finding : diagnose(*planned.plan, *hosts)) findings.push_back(std::move(finding));
  } else {
    findings.push_back({Mark::Note, "graph", "fix this first; the rest was not checked"});
  }
  return findings;
}

void run(const hc::LoadOptions& options) {
  Needs needs;
  std::vector<Finding> findings;
  if (!options.file.empty()) findings = examine_graph(options, needs);
  const Facts facts = gather_facts(needs.questions());
  for (auto& finding : diagnose(needs, facts)) findings.push_back(std::move(finding));
  auto machine = diagnose(facts);
  machine.insert(machine.end(), findings.begin(), findings.end());
  print(as_text(machine));
  if (is_ill(machine)) throw Failure(1);
}

}  // namespace

void add_doctor(CLI::App& app) {
  auto options = std::make_shared<hc::LoadOptions>();
  auto* verb = app.add_subcommand("doctor", "Check this machine, and the requirements of a graph");
  auto* graph =
      verb->add_option("graph", options->file, "a graph file (TOML), or the name of a shipped one")
          ->transform(find_graph);
  verb->add_option("--set", options->settings, "MODULE.PARAMETER=VALUE; may be repeated")
      ->allow_extra_args(false)
      ->needs(graph);
  verb->callback([options] { run(*options); });
}

}  // namespace tool
