// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "gaze.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"gaze",
                    "Turns the head to a target, and bids for the head while there is one."};
  Gaze gaze{module};
  return module.run(argc, argv);
}
