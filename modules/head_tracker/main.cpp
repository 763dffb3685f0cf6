// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "head_tracker.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "head_tracker", "Follows a person's head by an opentrack tracker.", {.keep_running = true}};
  HeadTracker tracker{module};
  return module.run(argc, argv);
}
