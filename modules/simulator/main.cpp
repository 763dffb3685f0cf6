// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "simulator.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"simulator", "A robot head in a furnished room: eyes, ears and ground truth."};
  Simulator simulator{module};
  return module.run(argc, argv);
}
