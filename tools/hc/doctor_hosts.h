// SPDX-License-Identifier: Apache-2.0
#pragma once
// Checks the needs of a graph on its other hosts, by asking their agents.

#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/plan.h>

#include "doctor_findings.h"

namespace tool {

/// The part of a plan that runs on a host; empty: the host of `hc run`.
hc::Plan part_of(const hc::Plan& plan, const std::string& host);

/// Findings about the other hosts of a plan, each with the host as its subject.
std::vector<Finding> diagnose(const hc::Plan& plan, hc::Hosts& hosts);

/// An agent's answer to a question of diagnose().
std::string examine(const std::string& question);

}  // namespace tool
