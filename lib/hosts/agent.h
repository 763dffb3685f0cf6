// SPDX-License-Identifier: Apache-2.0
#pragma once
// The far end of a graph over several hosts: starts modules for a `hc run` elsewhere, and ends with
// the connection to it.

#include <functional>
#include <string>

#include <hc/base/result.h>

namespace hc::hosts {

struct AgentOptions {
  int in = 0, out = 1;  ///< the connection
  int stop = -1;        ///< descriptor that is readable when the agent is to end
  std::string version;  ///< of this program, which must be that of `hc run`
  /// Answers Host::examine(), on another thread; may be empty.
  std::function<std::string(const std::string& question)> examine;
};

/// Does what it is asked to until the connection ends, is silent for 3 s, or `stop` is readable.
/// Nothing that it started is left then.
///
/// Errors: System; Closed, with the reason, unless the other end has ended the connection.
Status run_agent(const AgentOptions& options);

}  // namespace hc::hosts
