// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a graph needs of the hosts that its modules run on, asked of their agents.

#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/plan.h>

#include "diagnosis.h"

namespace tool {

/// The part of a plan that runs on one host; empty: that of `hc run`.
hc::Plan part_of(const hc::Plan& plan, const std::string& host);

/// What the other hosts of a plan lack or have for it, each with its host's name first.
std::vector<Finding> diagnose(const hc::Plan& plan, hc::Hosts& hosts);

/// What an agent answers: what this host has of what is asked for.
std::string examine(const std::string& question);

}  // namespace tool
