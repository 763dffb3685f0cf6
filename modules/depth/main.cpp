// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "depth.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{
      "depth", "Finds the depth of a scene from a rectified stereo pair.", {.background = true}};
  Depth depth{module};
  return module.run(argc, argv);
}
