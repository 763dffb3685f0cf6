// SPDX-License-Identifier: Apache-2.0
#pragma once
// `hc agent`: starts modules for a `hc run` on another host, and ends with its connection.

#include <functional>
#include <string>

#include <hc/base/result.h>

namespace hc::hosts {

struct AgentOptions {
  int in = 0, out = 1;  ///< the connection
  int stop = -1;        ///< readable when the agent must end
  std::string version;  ///< of this program; must equal that of `hc run`
  /// Answers Host::examine(), on another thread; may be empty.
  std::function<std::string(const std::string& question)> examine;
};

/// Executes orders until the connection ends, is silent for 3 s, or `stop` is readable. On return
/// all its processes have ended.
///
/// Errors: System; Closed, with the reason, unless the other end has closed the connection.
Status run_agent(const AgentOptions& options);

}  // namespace hc::hosts
