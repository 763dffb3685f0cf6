// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "stereo_calibration.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"stereo_calibration",
                    "Finds the geometry of two cameras from views of a board."};
  StereoCalibration calibration{module};
  return module.run(argc, argv);
}
