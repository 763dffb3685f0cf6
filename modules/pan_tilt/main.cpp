// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "pan_tilt.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"pan_tilt", "Turns the head by a FLIR pan-tilt unit; reports where it looks."};
  PanTilt pan_tilt{module};
  return module.run(argc, argv);
}
