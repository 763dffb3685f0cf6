// SPDX-License-Identifier: Apache-2.0
// hc agent: starts modules on this host for a `hc run` on another, which runs it through ssh.
#include <unistd.h>

#include <hc/os/program.h>
#include <hosts/agent.h>

#include "common.h"
#include "doctor_hosts.h"
#include "verbs.h"

namespace tool {

void add_agent(CLI::App& app) {
  auto* verb = app.add_subcommand(
      "agent", "Start modules for hc run on another host, which runs this through ssh");
  verb->callback([] {
    if (::isatty(STDIN_FILENO) == 1)
      throw Failure(hc::Code::Invalid,
                    "do not run this by hand: hc run does so through ssh, for modules with host = "
                    "\"NAME\"; see spec/graph.md");
    allow_descriptors();
    hc::hosts::AgentOptions options;
    options.stop = hc::stop_descriptor();
    options.version = HC_VERSION;
    options.examine = examine;
    if (auto ended = hc::hosts::run_agent(options); !ended) throw Failure(ended.error());
  });
}

}  // namespace tool
