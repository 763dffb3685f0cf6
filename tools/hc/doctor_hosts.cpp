// SPDX-License-Identifier: Apache-2.0
#include "doctor_hosts.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include <hc/os/program.h>

#include "doctor_facts.h"

namespace tool {
namespace {

using Json = nlohmann::json;

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Errors: Malformed.
hc::Result<Facts> facts_of(const std::string& answer) try {
  const auto json = Json::parse(answer);
  Facts facts;
  facts.display = json.at("display");
  facts.processors = json.at("processors");
  json.at("problems").get_to(facts.problems);
  return facts;
} catch (const Json::exception& error) {
  return hc::Error{hc::Code::Malformed, error.what()};
}

}  // namespace

hc::Plan part_of(const hc::Plan& plan, const std::string& host) {
  hc::Plan part;
  for (const auto& module : plan.modules)
    if (module.host == host) part.modules.push_back(module);
  return part;
}

std::vector<Finding> diagnose(const hc::Plan& plan, hc::Hosts& hosts) {
  std::set<std::string> names;
  for (const auto& module : plan.modules)
    if (!module.host.empty()) names.insert(module.host);
  std::vector<Finding> findings;
  for (const auto& name : names) {
    const auto needs = needs_of(part_of(plan, name));
    const auto host = hosts.find(name);
    hc::Result<std::string> answer = hc::Error{hc::Code::Closed, "not connected"};
    const auto served = hosts.serve([&] {
      if (host) answer = host->examine(text_of(needs.questions()), hc::stop_descriptor());
    });
    if (!served) answer = served.error();
    auto facts = answer ? facts_of(*answer) : answer.error();
    const std::string what = "host " + name;
    if (!facts) {
      findings.push_back({Mark::Missing, what, facts.error().text()});
      continue;
    }
    findings.push_back({Mark::Ok, what, "connected"});
    for (auto& finding : diagnose(needs, *facts)) {
      finding.text = finding.what + ": " + finding.text;
      finding.what = what;
      findings.push_back(std::move(finding));
    }
  }
  return findings;
}

std::string examine(const std::string& question) {
  const auto asked = Json::parse(question, nullptr, false);
  std::vector<std::string> questions;
  if (asked.is_array())
    for (const auto& each : asked)
      if (each.is_string()) questions.push_back(each);
  const Facts facts = gather_facts(questions);
  return text_of(
      {{"display", facts.display}, {"processors", facts.processors}, {"problems", facts.problems}});
}

}  // namespace tool
