// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <hc/module/module.h>

int run_actor(int argc, char** argv, const hc::Clock& clock) {
  hc::Module module{"actor", "Takes commands and reports which.", {.clock = &clock}};
  auto command = module.input("command", hc::table(), "any numbers", {.actor = true});
  auto done = module.output("done", hc::table<std::int32_t>(),
                            "2 x 1 for each command: its mode, and the mode in focus at that time");
  module.on(command, [&](const auto& message) {
    done.send({message.header.mode, module.focus()});
  });
  return module.run(argc, argv);
}
