// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reaches other hosts through ssh, where `hc agent` starts the modules of a graph.

#include <memory>
#include <string>

#include <graph/hosts.h>

namespace hc::hosts {

/// Makes the key of this run, and connects to nobody yet.
///
/// @param version  of this program, which an agent must have too. Errors: System.
Result<std::unique_ptr<Hosts>> make_hosts(std::string version);

}  // namespace hc::hosts
