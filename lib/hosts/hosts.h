// SPDX-License-Identifier: Apache-2.0
#pragma once
// Runs modules of a graph on other hosts, through ssh and `hc agent`.

#include <memory>
#include <string>

#include <graph/hosts.h>

namespace hc::hosts {

/// Makes the key of this run; connects to no host yet.
///
/// @param version  of this program; agents must have the same. Errors: System.
Result<std::unique_ptr<Hosts>> make_hosts(std::string version);

}  // namespace hc::hosts
