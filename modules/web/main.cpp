// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "web.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"web",
                    "Serves a page: the graph live, its streams, and the driver's seat.",
                    {.keep_running = true}};
  Web web{module};
  return module.run(argc, argv);
}
