// SPDX-License-Identifier: Apache-2.0
#include <transports/all.h>

#include "marker.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"marker",
                    "Finds ArUco, AprilTag and coloured square markers, and their poses."};
  MarkerSearch search{module};
  return module.run(argc, argv);
}
