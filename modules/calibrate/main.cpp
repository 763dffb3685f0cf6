// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "calibrator.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"calibrate", "Finds how a head's eyes are mounted, by turning it."};
  Calibrator calibrator{module};
  const int status = module.run(argc, argv);
  calibrator.log_result();
  return status;
}
